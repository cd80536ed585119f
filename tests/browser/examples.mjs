// The examples of web-client/examples in a stranger's project (package.mjs), and the pictures that
// they draw.

import assert from 'node:assert/strict';
import {copyFileSync, mkdirSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {kTimeoutMs} from './browser.mjs';
import {coloredShare} from './png.mjs';

const client = fileURLToPath(new URL('../../web-client/', import.meta.url));
const kExamples = ['three_level', 'three_stream', 'vtk_level', 'vtk_stream'];
/** The least coloured share of the picture's middle: each example shows its mesh in viridis. */
const kMinColored = 0.05;

/**
 * Pages of the project for each example, as examples/README.md says; vite.config.js builds them
 * beside index.html.
 */
export function addExamples(project) {
  for (const folder of ['public', 'examples']) mkdirSync(join(project, folder));
  copyFileSync(
    join(client, 'node_modules/three/examples/jsm/libs/draco/gltf/draco_decoder.js'),
    join(project, 'public/draco_decoder.js'),
  );
  copyFileSync(join(client, 'examples/page.js'), join(project, 'examples/page.js'));
  for (const name of kExamples) {
    copyFileSync(join(client, `examples/${name}.js`), join(project, `examples/${name}.js`));
    const decoder = name === 'vtk_level' ? '<script src="/draco_decoder.js"></script>' : '';
    writeFileSync(
      join(project, `${name}.html`),
      `<!doctype html><html lang="en">
<head><title>${name}</title><style>body { margin: 0 }</style></head>
<body>${decoder}<script type="module" src="/examples/${name}.js"></script></body></html>`,
    );
  }
  const pages = ['index', ...kExamples].map((name) => `${name}.html`);
  writeFileSync(
    join(project, 'vite.config.js'),
    "export default {build: {target: 'es2022', chunkSizeWarningLimit: 4000, rollupOptions: " +
      `{input: ${JSON.stringify(pages)}}}};\n`,
  );
}

/**
 * Waits for a picture that shows something, and returns its coloured share. `problems` is a list
 * that ends the wait when it fills.
 */
export async function waitForColor(browser, page, name, problems = []) {
  let share = 0;
  for (
    const end = Date.now() + kTimeoutMs;
    share < kMinColored && Date.now() < end && problems.length === 0;
  ) {
    await page.waitForTimeout(300);
    share = coloredShare(await browser.picture(page, name));
  }
  assert.deepEqual(problems, [], name);
  assert.ok(share >= kMinColored, `${name}: ${share} of the picture is coloured`);
  return share;
}

/** Each must show the mesh. */
export async function checkExamples(browser, server) {
  for (const name of kExamples) {
    const page = await browser.page('about:blank');
    const problems = [];
    page.on('pageerror', (error) => problems.push(String(error)));
    await page.goto(`${server.url}${name}.html?mesh=fin`);
    const share = await waitForColor(browser, page, name, problems);
    await page.context().close();
    console.log(`ok    ${name}: ${(100 * share).toFixed(0)} % of the picture is the mesh`);
  }
}
