// A list of segments, whose cells differ, on a web server that knows nothing about it.

import assert from 'node:assert/strict';
import {cpSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {differingShare} from './png.mjs';
import {makeLog} from './programs.mjs';
import {hostFolder, makeSite} from './static_host.mjs';

const kSegments = [
  {log: 'flow.0.qtet', times: [0, 1]},
  {log: 'flow.1.qtet', times: [2]},
];

const kCamera = [1, -2.5, 1, 0, 0, 0];
/** By so much the two meshes may differ in size. */
const kMaxMoved = 0.003;
/** Longer than a segment of one instant is played. */
const kSlowFrameMs = 700;
/** A picture of the segment before, and one of the next. */
const kMaxWaiting = 2;

/** By segment: its log, which is made once. */
const made = new Map();

/** The fin with its first two instants, and with the third alone in finer cells. */
function makeSegments({bin, out, viewer}) {
  const make = (segment, cells) => {
    const known = made.get(segment);
    if (known) return known;
    const fields = kSegments[segment].times.map((time) => `Density@${time}`).join();
    const sample = ['fin', '--steps', '3', '--cells', String(cells)];
    const options = ['--fields', fields, '--measure', 'none'];
    made.set(segment, makeLog(bin, `flow.${segment}`, out, sample, options));
    return made.get(segment);
  };
  const logs = [make(0, 212000), make(1, 300000)];
  const folder = makeSite(join(out, 'segments'), viewer, logs[0]);
  cpSync(join(logs[1].folder, 'flow.1.qtet'), join(folder, 'flow.1.qtet'));
  const write = (name, segments) =>
    writeFileSync(join(folder, name), JSON.stringify({qtet: 'series', segments}));
  write('flow.json', kSegments);
  write('broken.json', [kSegments[0], {log: 'missing.qtet', times: [2]}]);
  write('holey.json', [kSegments[0], {log: 'missing.qtet', times: [1.5]}, kSegments[1]]);
  write('wrong.json', [kSegments[0], {log: '../flow.1.qtet', times: [2]}]);
  return {folder, logs};
}

/** Counts the frames from now on, and those without a mesh. */
const countFrames = (view) => {
  const {parts} = view.scene;
  const {draw} = parts;
  globalThis.framesSeen = {all: 0, blank: 0};
  parts.draw = function drawCounted(eye) {
    ++globalThis.framesSeen.all;
    if (!this.surface.visible) ++globalThis.framesSeen.blank;
    return draw.call(this, eye);
  };
};

/** The texts of the time bar. */
const barOf = ({page}) =>
  page.evaluate(() => {
    const bar = window.qtetViewer.shadowRoot.querySelector('.time');
    const {ariaValueText, max, value} = bar.querySelector('input');
    return [max, value, ariaValueText];
  });

async function waitForDigest(viewer, {meshDigest}) {
  await viewer.page.waitForFunction(
    async (digest) =>
      window.qtetViewer.state === 'complete' && (await window.qtetViewer.digest()) === digest,
    meshDigest,
    {polling: 100},
  );
  await viewer.settle();
}

async function stepsOverTheBorder(viewer, logs) {
  const {page} = viewer;
  await waitForDigest(viewer, logs[0]);
  assert.deepEqual(await barOf(viewer), ['2', '0', 't = 0']);
  await page.evaluate((state) => {
    window.qtetViewer.cameraState = state;
  }, kCamera);
  await viewer.settle();
  const first = await viewer.screenshot('segment-0');
  await viewer.inView(countFrames);
  await page.locator('qtet-viewer .scene').focus();
  await page.keyboard.press('.');
  await page.keyboard.press('.');
  await waitForDigest(viewer, logs[1]);
  const second = await viewer.screenshot('segment-1');
  assert.deepEqual(await barOf(viewer), ['2', '2', 't = 2']);
  const share = differingShare(first, second);
  assert.ok(share > 0.02 && share < 0.5, `${share} of the picture differs`);
  const [camera, ...words] = await page.evaluate(() => {
    const {cameraState, view} = window.qtetViewer;
    return [cameraState, view.get('clip'), view.get('field'), view.get('time')];
  });
  assert.deepEqual(words, ['y:0.4', 'Density', '2']);
  // In the same place. Its state is relative to the mesh, and finer cells fill the shape more.
  kCamera.forEach((place, i) => {
    assert.ok(Math.abs(camera[i] - place) < kMaxMoved, `the camera is at ${camera}`);
  });
  await page.keyboard.press(',');
  await waitForDigest(viewer, logs[0]);
  const {all, blank} = await viewer.inView(() => globalThis.framesSeen);
  assert.ok(all > 1, 'nothing was drawn');
  assert.equal(blank, 0, 'frames without a mesh');
  assert.deepEqual(await barOf(viewer), ['2', '1', 't = 1']);
}

async function playsOverTheBorder({page}) {
  const seen = await page.evaluate(
    () =>
      new Promise((resolve) => {
        const times = [];
        const viewer = window.qtetViewer;
        viewer.addEventListener('time-change', ({detail}) => {
          times.push(detail.time);
          if (times.includes(2) && detail.time === 0) resolve(times);
        });
        viewer.playing = true;
      }),
  );
  assert.ok(seen.includes(2), String(seen));
  await page.evaluate(() => {
    window.qtetViewer.playing = false;
  });
}

async function aListOfSegmentsIsOneSeries(context) {
  const {folder, logs} = makeSegments(context);
  const host = await hostFolder(folder);
  try {
    const query = 'field=Density&clip=y:0.4';
    const viewer = await context.browser.open(`${host.url}?src=flow.json&${query}`);
    await viewer.waitForPicture();
    await stepsOverTheBorder(viewer, logs);
    await playsOverTheBorder(viewer);
    assert.deepEqual(viewer.problems, []);
    // a link opens the segment of its time
    const linked = await context.browser.open(`${host.url}?src=flow.json&time=1.9&${query}`);
    await linked.waitForPicture();
    await waitForDigest(linked, logs[1]);
    assert.deepEqual(await barOf(linked), ['2', '2', 't = 2']);
  } finally {
    host.close();
  }
}

async function aListsErrorsSayWhere({browser, ...context}) {
  const {folder, logs} = makeSegments(context);
  const host = await hostFolder(folder);
  try {
    const wrong = await browser.open(`${host.url}?src=wrong.json`);
    await wrong.waitForState('failed');
    const said = await wrong.text('.notice p');
    assert.match(said, /wrong\.json cannot be opened: segments\[1\]\.log is "\.\.\/flow\.1\.qtet"/);
    const broken = await browser.open(`${host.url}?src=broken.json&clip=none`);
    await waitForDigest(broken, logs[0]);
    const before = await broken.counts();
    await broken.page.evaluate(() => window.qtetViewer.setAttribute('time', '2'));
    await broken.waitForState('failed');
    assert.match(await broken.text('.notice p'), /missing\.qtet is answered by "404/);
    assert.deepEqual(await broken.counts(), before, 'the last picture is gone');
    await broken.page.evaluate(() => window.qtetViewer.removeAttribute('time'));
    await waitForDigest(broken, logs[0]);
    assert.ok(await broken.page.locator('qtet-viewer .notice').isHidden());
  } finally {
    host.close();
  }
}

/** Each frame waits, as if the graphics were slow. Counts the pictures that wait for one. */
const drawSlowly = (view, frameMs) => {
  globalThis.requestAnimationFrame = (draw) => setTimeout(draw, frameMs);
  globalThis.mostWaiting = 0;
  const {show} = view;
  view.show = function showCounted(...words) {
    show.apply(this, words);
    globalThis.mostWaiting = Math.max(globalThis.mostWaiting, this.frames.waiting.length);
  };
};

/** Plays until the time is `last` for the `rounds`th time. Returns the times and events so far. */
const playRounds = ([last, rounds]) =>
  new Promise((resolve) => {
    const viewer = window.qtetViewer;
    const seen = [];
    viewer.addEventListener('load', () => seen.push('load'));
    viewer.addEventListener('time-change', ({detail: {time, playing}}) => {
      if (!playing) return;
      seen.push(time);
      if (seen.filter((its) => its === last).length < rounds) return;
      viewer.playing = false;
      resolve(seen);
    });
    viewer.playing = true;
  });

async function playingShowsEachSegmentOnSlowGraphics(context) {
  const {folder} = makeSegments(context);
  const host = await hostFolder(folder);
  try {
    const viewer = await context.browser.open(`${host.url}?src=holey.json&clip=none`);
    await viewer.waitForPicture();
    await viewer.inView(drawSlowly, kSlowFrameMs);
    const seen = await viewer.page.evaluate(playRounds, [2, 3]);
    // Each segment that can be opened has a picture before the time goes on to another one.
    const others = seen.filter((its) => its !== 1.5).join(' ');
    assert.match(others, /^0 (?:1 )?2 load 0 load (?:1 )?2 load 0 load (?:1 )?2$/);
    assert.ok(seen.includes(1.5), String(seen));
    const most = await viewer.inView(() => globalThis.mostWaiting);
    assert.ok(most <= kMaxWaiting, `${most} pictures waited for a frame`);
  } finally {
    host.close();
  }
}

export const segmentChecks = {
  aListOfSegmentsIsOneSeries,
  aListsErrorsSayWhere,
  playingShowsEachSegmentOnSlowGraphics,
};
