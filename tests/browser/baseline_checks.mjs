// Compares the most important pictures with those in tests/browser/baselines. Somebody has looked
// at each of them. QTET_BASELINES=write keeps the current pictures instead of comparing: look at
// every changed file before you commit it.

import assert from 'node:assert/strict';
import {copyFileSync, existsSync, readFileSync} from 'node:fs';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {hides, kScene} from './browser.mjs';
import {differingBlocks, differingShare, largestDifference, readPng} from './png.mjs';

const kFolder = fileURLToPath(new URL('baselines/', import.meta.url));
/**
 * The share of blocks of 4 x 4 pixels that may differ. Another machine's antialiasing and fonts
 * change fewer; a missing cap, edge or light changes more.
 */
const kMaxDiffering = 0.01;

const kPhoneSize = {viewport: {width: 390, height: 844}, isMobile: true, hasTouch: true};
/**
 * name: [query, device, whether panels are shown]. Whole meshes only, so that nothing depends on
 * the simplifier.
 */
const kPictures = {
  boundary: ['mesh=fin&field=Velocity&clip=none', kScene],
  'clip-caps': ['mesh=box&clip=y:0.5', kScene],
  'clip-cells': ['mesh=box&clip=y:0.5&clip-mode=cells', kScene],
  isosurfaces: ['mesh=fin&field=Velocity&colormap=turbo&iso=Density=1.3,2.5&surface=off', kScene],
  volume: ['mesh=box&volume=0,0.05,0.2,0.5', kScene],
  dark: [
    'mesh=box&clip=x:0.4&colormap=cool-warm',
    {viewport: {width: 960, height: 600}, colorScheme: 'dark'},
    true,
  ],
  phone: ['mesh=box&clip=y:0.5', kPhoneSize, true],
};

async function looksAsItDid({server, browser, out}) {
  const notes = [];
  for (const [name, [query, device, panels = false]] of Object.entries(kPictures)) {
    const viewer = await browser.open(
      `${server.url}?${query}`,
      device,
      panels ? undefined : hides('panel'),
    );
    await viewer.waitForState('complete');
    await viewer.waitForPicture();
    await viewer.waitForLines();
    if (query.includes('volume')) await viewer.restVolume();
    await viewer.settle();
    await viewer.settle();
    const seen = await viewer.screenshot(`baseline-${name}`);
    const path = `${kFolder}${name}.png`;
    if (process.env.QTET_BASELINES === 'write') {
      copyFileSync(join(out, `baseline-${name}.png`), path);
      continue;
    }
    assert.ok(existsSync(path), `${path} is missing`);
    const differing = differingBlocks(readPng(readFileSync(path)), seen);
    notes.push(`${name} ${(100 * differing).toFixed(2)} %`);
    assert.ok(
      differing <= kMaxDiffering,
      `${name}: ${(100 * differing).toFixed(2)} % look otherwise than in ${path}`,
    );
  }
  return notes.join(', ');
}

/** Seen from afar no cell has an edge, and from close up all have. */
async function edgesFadeTogether({server, browser}) {
  const viewer = await browser.open(
    `${server.url}?mesh=fin&field=Velocity&clip=none`,
    kScene,
    hides('panel'),
  );
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const seen = async (edges, name) => {
    await viewer.page.evaluate((on) => window.qtetViewer.setAttribute('edges', on), edges);
    await viewer.settle();
    return viewer.screenshot(name);
  };
  await viewer.page.evaluate(() => window.qtetViewer.meshView.zoom(3));
  const far = [await seen('on', 'edges-far'), await seen('off', 'edges-far-off')];
  assert.equal(largestDifference(...far), 0, 'some cells have edges and most have none');
  await viewer.page.evaluate(() => window.qtetViewer.meshView.zoom(0.1));
  const near = [await seen('off', 'edges-near-off'), await seen('on', 'edges-near')];
  const share = differingShare(...near);
  assert.ok(share > 0.03, `edges take ${share} of the picture`);
  return `${(100 * share).toFixed(1)} % of a near picture are edges`;
}

/** The angle between two colours, in degrees: 0 if one is the other times a factor. */
function angleBetween(a, b) {
  const dot = (p, q) => p.reduce((sum, value, c) => sum + value * q[c], 0);
  return (Math.acos(Math.min(1, dot(a, b) / Math.sqrt(dot(a, a) * dot(b, b)))) * 180) / Math.PI;
}

/** Three sides of a box, each in another light; a pixel's colour is that of the legend. */
async function lightKeepsTheHue({server, browser}) {
  const viewer = await browser.open(
    `${server.url}?mesh=box&clip=none&edges=off&range=-9,-8`,
    kScene,
    hides('panel'),
  );
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  await viewer.settle();
  await viewer.settle();
  const seen = await viewer.screenshot('light');
  const kLast = [253, 231, 37]; // of viridis: all values lie above the range
  const sides = new Map();
  for (let y = 95; y < seen.height; ++y) {
    for (let x = 80; x < seen.width; ++x) {
      const color = seen.at(x, y);
      const key = color.join();
      if (Math.max(...color) - Math.min(...color) > 100) sides.set(key, (sides.get(key) ?? 0) + 1);
    }
  }
  const large = [...sides].filter(([, count]) => count > 500).map(([key]) => key.split(','));
  const colors = large.map((channels) => channels.map(Number));
  assert.ok(colors.length >= 3, `${colors.length} sides differ in light`);
  const off = Math.max(...colors.map((color) => angleBetween(color, kLast)));
  assert.ok(off < 3, `a side's colour is ${off.toFixed(1)} degrees off the legend's`);
  const lights = colors.map((color) => Math.hypot(...color) / Math.hypot(...kLast));
  const contrast = Math.max(...lights) - Math.min(...lights);
  assert.ok(contrast > 0.12, `the sides' light differs by ${contrast.toFixed(2)} only`);
  return `${off.toFixed(1)} degrees off, light ${lights.map((its) => its.toFixed(2)).join(', ')}`;
}

export const baselineChecks = {looksAsItDid, edgesFadeTogether, lightKeepsTheHue};
