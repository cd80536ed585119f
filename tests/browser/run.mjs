// The whole system: the tool's log, the server, and the viewer in Chromium with software WebGL.
//   node run.mjs --bin DIR --viewer DIR --out DIR [--only REGEX] [--retries N]
// A check that fails is tried up to N times more (default 0). If it passes then, it is called
// "flaky": on a shared machine a browser may stall for longer than any check foresees. The first
// failure is printed all the same, for it may be a fault that shows only sometimes.
// Needs web-client/node_modules (playwright-core) and a Chromium: /usr/bin/chromium, or the one
// that QTET_CHROMIUM names.

import {mkdirSync} from 'node:fs';
import {parseArgs} from 'node:util';
import {Browser} from './browser.mjs';
import {baselineChecks} from './baseline_checks.mjs';
import {checks} from './checks.mjs';
import {edgeChecks} from './edge_checks.mjs';
import {elementChecks} from './element_checks.mjs';
import {legendChecks} from './legend_checks.mjs';
import {monkeyChecks} from './monkey_checks.mjs';
import {publishChecks} from './publish_checks.mjs';
import {recoveryChecks} from './recovery_checks.mjs';
import {transportChecks} from './transport_checks.mjs';
import {volumeChecks} from './volume_checks.mjs';
import {makeLog, Server} from './programs.mjs';

const {values: options} = parseArgs({
  options: {
    bin: {type: 'string'},
    viewer: {type: 'string'},
    out: {type: 'string'},
    only: {type: 'string', default: ''},
    retries: {type: 'string', default: '0'},
  },
});
const retries = Number(options.retries);
if (!Number.isInteger(retries) || retries < 0) {
  console.error(`--retries ${options.retries}: give a number of tries, 0 or more`);
  process.exit(2);
}
if (!options.bin || !options.viewer || !options.out) {
  console.error(
    'Usage: node run.mjs --bin DIR --viewer DIR --out DIR [--only REGEX] [--retries N]',
  );
  process.exit(2);
}

const all = {
  ...checks,
  ...elementChecks,
  ...transportChecks,
  ...publishChecks,
  ...volumeChecks,
  ...edgeChecks,
  ...legendChecks,
  ...recoveryChecks,
  ...monkeyChecks,
  ...baselineChecks,
};
const chosen = Object.entries(all).filter(([name]) => new RegExp(options.only).test(name));
if (chosen.length === 0) {
  console.error(`no check's name matches --only ${options.only}`);
  process.exit(2);
}

mkdirSync(options.out, {recursive: true});
const logs = {
  fin: makeLog(options.bin, 'fin', options.out),
  box: makeLog(options.bin, 'box', options.out),
};
const server = new Server(options.bin, logs.fin.folder, options.viewer);
const browser = await Browser.launch(options.out);

/** Runs the check and returns its note. Throws the fault that it finds. */
async function run(name, check) {
  try {
    await server.start();
    return await check({
      server,
      browser,
      logs,
      viewer: options.viewer,
      out: options.out,
      bin: options.bin,
    });
  } catch (thrown) {
    await browser.saveFailure(name);
    throw thrown;
  } finally {
    await browser.closePages();
  }
}

const failed = [],
  flaky = [];
try {
  for (const [name, check] of chosen) {
    for (let tries = 0; tries <= retries; ++tries) {
      const start = Date.now();
      try {
        const note = await run(name, check);
        console.log(`ok    ${name} (${Date.now() - start} ms)${note ? `: ${note}` : ''}`);
        if (tries > 0) flaky.push(name);
        break;
      } catch (thrown) {
        const again = tries < retries;
        const because = thrown.cause ? `\nbecause ${thrown.cause.stack}` : '';
        console.log(`${again ? 'AGAIN' : 'FAIL '} ${name}: ${thrown.stack}${because}`);
        if (!again) failed.push(name);
        else server.kill(); // the server starts again, too
      }
    }
  }
} finally {
  await browser.close();
  server.kill();
}
if (flaky.length > 0) console.log(`passed, but not at once: ${flaky.join(', ')}`);
const failures = failed.length > 0 ? `${failed.length} failed: ${failed.join(', ')}; ` : '';
console.log(`${failures}screenshots are in ${options.out}`);
process.exit(failed.length === 0 ? 0 : 1);
