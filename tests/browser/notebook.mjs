// qtet.show in Jupyter: a notebook that nbclient runs and nbconvert exports, and the same one run
// by hand in the notebook's own page. Both keep what they show.
//   node notebook.mjs --bin DIR --out DIR [--python PYTHON]
// Exits with 77 where Jupyter is not installed (Debian: jupyter-notebook python3-ipykernel).

import assert from 'node:assert/strict';
import {execFileSync, spawn} from 'node:child_process';
import {mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';
import {parseArgs} from 'node:util';
import {freePort} from '../support/free_port.mjs';
import {Browser, kDesktop, kTimeoutMs} from './browser.mjs';
import {coloredShare} from './png.mjs';

const {values: options} = parseArgs({
  options: {
    bin: {type: 'string'},
    out: {type: 'string'},
    python: {type: 'string', default: '/usr/bin/python3'},
  },
});
const {python} = options;
const out = resolve(options.out);
const source = fileURLToPath(new URL('../../', import.meta.url));
const run = (words, more = {}) => execFileSync(python, words, {encoding: 'utf8', ...more});
try {
  run(['-c', 'import notebook, nbclient, nbconvert, ipykernel'], {stdio: 'pipe'});
} catch {
  console.log('skipped: Jupyter is not installed (Debian: jupyter-notebook python3-ipykernel)');
  process.exit(77);
}
rmSync(out, {recursive: true, force: true});
mkdirSync(join(out, 'work'), {recursive: true});

/** The package as pip installs it, and a home of its own for Jupyter's keys and settings. */
function installed() {
  run([join(source, '.packaging/python_backend.py'), join(out, 'wheel')], {stdio: 'pipe'});
  const [wheel] = readdirSync(join(out, 'wheel'));
  run(['-m', 'zipfile', '-e', join(out, 'wheel', wheel), join(out, 'site')]);
  const env = {...process.env, PYTHONPATH: join(out, 'site'), HOME: join(out, 'home')};
  delete env.QTET_LIBRARY;
  return env;
}

const kCells = [
  ['import qtet\n', "qtet.show('box.vtu')"],
  ["qtet.show('box.vtu', field='CellScalar', height=320)"],
];
const notebook = {
  cells: kCells.map((lines, i) => ({
    id: `cell${i}`,
    cell_type: 'code',
    execution_count: null,
    metadata: {},
    outputs: [],
    source: lines,
  })),
  metadata: {kernelspec: {name: 'python3', display_name: 'Python 3', language: 'python'}},
  nbformat: 4,
  nbformat_minor: 5,
};

/** Waits until each cell's frame shows the whole mesh, and looks at it. */
async function expectShown(page, browser, name) {
  const frames = page.locator('iframe[srcdoc]');
  await frames.nth(kCells.length - 1).waitFor();
  assert.equal(await frames.count(), kCells.length);
  for (let i = 0; i < kCells.length; ++i) {
    await frames.nth(i).scrollIntoViewIfNeeded();
    const frame = await (await frames.nth(i).elementHandle()).contentFrame();
    await frame.waitForFunction(() => window.qtetViewer?.state === 'complete', null, {
      timeout: kTimeoutMs,
    });
    const {tetrahedra} = await frame.evaluate(() => window.qtetViewer.statistics);
    assert.equal(tetrahedra, 3072);
    await page.waitForTimeout(500); // for the last frame
    const share = coloredShare(await browser.picture(page, `${name}_${i}`));
    assert.ok(share > 0.02, `cell ${i} of ${name} is blank: ${share} of the page is coloured`);
  }
}

async function exported(env, browser) {
  const path = join(out, 'work/exported.ipynb');
  writeFileSync(path, JSON.stringify(notebook));
  const convert = (...words) => run(['-m', 'nbconvert', ...words], {env, stdio: 'pipe'});
  convert('--execute', '--to', 'notebook', '--inplace', path);
  const {cells} = JSON.parse(readFileSync(path, 'utf8'));
  for (const {outputs} of cells) {
    assert.deepEqual(Object.keys(outputs[0].data).sort(), ['text/html', 'text/plain']);
    assert.match([outputs[0].data['text/plain']].flat().join(''), /^<qtet\.Shown [\d,]+ bytes/);
  }
  convert('--to', 'html', path);
  const page = await browser.blank({...kDesktop, offline: true});
  await page.goto(pathToFileURL(path.replace('.ipynb', '.html')).href);
  await expectShown(page, browser, 'exported');
}

async function byHand(env, browser) {
  const path = join(out, 'work/by_hand.ipynb');
  writeFileSync(path, JSON.stringify(notebook));
  const port = freePort();
  const words = ['-m', 'notebook', '--no-browser', '--allow-root', '--NotebookApp.token='];
  const server = spawn(python, [...words, `--port=${port}`, join(out, 'work')], {
    env,
    stdio: 'ignore',
  });
  try {
    const page = await browser.blank();
    const address = `http://127.0.0.1:${port}/notebooks/by_hand.ipynb`;
    for (const end = Date.now() + kTimeoutMs; ; await page.waitForTimeout(200)) {
      const answer = await page.goto(address).catch(() => null);
      if (answer?.ok()) break;
      assert.ok(Date.now() < end, 'the notebook server does not start');
    }
    await page.waitForFunction(() => window.Jupyter?.notebook?.kernel?.is_connected?.(), null, {
      timeout: kTimeoutMs,
    });
    await page.evaluate(() => window.Jupyter.notebook.execute_all_cells());
    await expectShown(page, browser, 'by_hand');
    await page.evaluate(() => window.Jupyter.notebook.save_notebook());
    server.kill();
    const {cells} = JSON.parse(readFileSync(path, 'utf8'));
    assert.ok(
      cells.every(({outputs}) => outputs[0]?.data['text/html']),
      'the notebook has no page',
    );
  } finally {
    server.kill();
  }
}

execFileSync(join(options.bin, 'qtet'), ['sample', 'box', '-o', join(out, 'work/box.vtu')]);
const env = installed();
const browser = await Browser.launch(out);
try {
  await exported(env, browser);
  await byHand(env, browser);
  console.log(`notebook: as exported and by hand; pictures are in ${out}`);
} finally {
  await browser.close();
}
