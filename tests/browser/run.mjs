// The whole system: the tool's log, the server, and the viewer in Chromium with software WebGL.
//   node run.mjs --bin DIR --viewer DIR --out DIR [--list NAME] [--only REGEX]
// Needs web-client/node_modules (playwright-core) and a Chromium: /usr/bin/chromium, or the one
// that QTET_CHROMIUM names.

import {mkdirSync} from 'node:fs';
import {parseArgs} from 'node:util';
import {Browser} from './browser.mjs';
import {processorSeconds} from './browser_processes.mjs';
import {axesChecks} from './axes_checks.mjs';
import {baselineChecks} from './baseline_checks.mjs';
import {checks} from './checks.mjs';
import {colorChecks} from './color_checks.mjs';
import {derivedChecks} from './derived_checks.mjs';
import {dropChecks} from './drop_checks.mjs';
import {edgeChecks} from './edge_checks.mjs';
import {elementChecks} from './element_checks.mjs';
import {galleryChecks} from './gallery_checks.mjs';
import {groundChecks} from './ground_checks.mjs';
import {histogramChecks} from './histogram_checks.mjs';
import {legendChecks} from './legend_checks.mjs';
import {lineChecks} from './line_checks.mjs';
import {monkeyChecks} from './monkey_checks.mjs';
import {movieChecks} from './movie_checks.mjs';
import {numberChecks} from './number_checks.mjs';
import {pageChecks} from './page_checks.mjs';
import {arrowChecks} from './arrow_checks.mjs';
import {partChecks} from './part_checks.mjs';
import {streamlineChecks} from './streamline_checks.mjs';
import {panelChecks} from './panel_checks.mjs';
import {pinChecks} from './pin_checks.mjs';
import {pictureChecks} from './picture_checks.mjs';
import {posterChecks} from './poster_checks.mjs';
import {publishChecks} from './publish_checks.mjs';
import {recoveryChecks} from './recovery_checks.mjs';
import {segmentChecks} from './segment_checks.mjs';
import {timeChecks} from './time_checks.mjs';
import {transportChecks} from './transport_checks.mjs';
import {undoChecks} from './undo_checks.mjs';
import {volumeChecks} from './volume_checks.mjs';
import {warpChecks} from './warp_checks.mjs';
import {makeLog, Server} from './programs.mjs';

const {values: options} = parseArgs({
  options: {
    bin: {type: 'string'},
    viewer: {type: 'string'},
    out: {type: 'string'},
    only: {type: 'string', default: ''},
    list: {type: 'string', default: ''},
  },
});
if (!options.bin || !options.viewer || !options.out) {
  console.error(
    'Usage: node run.mjs --bin DIR --viewer DIR --out DIR [--list NAME] [--only REGEX]',
  );
  process.exit(2);
}

/** Each list is a test of its own (tests/system_tests.cmake), beside the others. */
const lists = {
  checks,
  element: {...elementChecks, ...lineChecks},
  transport: {...transportChecks, ...movieChecks, ...segmentChecks},
  publish: {...publishChecks, ...posterChecks, ...pageChecks, ...dropChecks, ...galleryChecks},
  volume: volumeChecks,
  edge: {
    ...edgeChecks,
    ...warpChecks,
    ...axesChecks,
    ...groundChecks,
    ...pinChecks,
    ...numberChecks,
  },
  legend: {
    ...partChecks,
    ...arrowChecks,
    ...streamlineChecks,
    ...legendChecks,
    ...derivedChecks,
    ...colorChecks,
    ...histogramChecks,
    ...undoChecks,
  },
  panel: {...panelChecks, ...pictureChecks, ...timeChecks},
  recovery: recoveryChecks,
  monkey: monkeyChecks,
  baseline: baselineChecks,
};
if (options.list && !(options.list in lists)) {
  console.error(`no list is called ${options.list}; the lists: ${Object.keys(lists).join(', ')}`);
  process.exit(2);
}
const all = options.list ? lists[options.list] : Object.assign({}, ...Object.values(lists));
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
const browser = await Browser.launch(options.out, {forChecks: true});

/** Seconds on the clock and of processors, which other programs on the machine change less. */
function stopwatch() {
  const [start, before] = [Date.now(), processorSeconds()];
  return () =>
    `${((Date.now() - start) / 1000).toFixed(1)} s, ` +
    `${(processorSeconds() - before).toFixed(1)} s of processors`;
}

/** Runs the check and returns its note. Throws the fault that it finds. */
async function run(name, check) {
  let areSound = false;
  try {
    await server.start();
    const note = await check({
      server,
      browser,
      logs,
      viewer: options.viewer,
      out: options.out,
      bin: options.bin,
    });
    areSound = true;
    return note;
  } catch (thrown) {
    await browser.saveFailure(name);
    throw thrown;
  } finally {
    await browser.closePages({areSound});
  }
}

const failed = [];
try {
  for (const [name, check] of chosen) {
    const took = stopwatch();
    try {
      const note = await run(name, check);
      console.log(`ok    ${name} (${took()})${note ? `: ${note}` : ''}`);
    } catch (thrown) {
      const because = thrown.cause ? `\nbecause ${thrown.cause.stack}` : '';
      console.log(`FAIL  ${name}: ${thrown.stack}${because}`);
      failed.push(name);
      server.kill(); // the next check starts it again
    }
  }
} finally {
  await browser.close();
  server.kill();
}
const failures = failed.length > 0 ? `${failed.length} failed: ${failed.join(', ')}; ` : '';
console.log(`${failures}screenshots are in ${options.out}`);
process.exit(failed.length === 0 ? 0 : 1);
