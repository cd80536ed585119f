// Rays of a volume beside edges of the mesh: every pixel is compared with what is known about
// cubes.

import assert from 'node:assert/strict';
import {hides, kScene} from './browser.mjs';
import {serveMesh} from './programs.mjs';
import {linearBox} from './volume_checks.mjs';

/** Cubes along the shortest side. Below: which cubes are there. */
const kSponge = 3;
const isInSponge = (x, y, z) => (x + y + z) % 2 === 0 || (7 * x + 3 * y + 5 * z) % 3 === 0;

/**
 * Runs in the worker that draws; the opacity is the same everywhere. Counts the pixels that show
 * anything, and those that differ from the sum of the cubes on their line of sight.
 */
function compareWithCubes(view, sizes, cubes) {
  const {volume, graphics} = view.scene;
  const {
    drawer: {
      deep,
      caster: {look, ray},
    },
    fine: {
      of: {vertices},
    },
  } = volume;
  const {gl} = graphics;
  const {fromCanvas: m} = view.pose;
  const {width, height} = deep.volume;
  deep.volume.begin();
  const drawn = new Float32Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, drawn);
  const edges = [0, 1, 2].map((axis) => {
    const all = vertices.filter((_, i) => i % 4 === axis);
    const low = all.reduce((a, b) => Math.min(a, b)),
      high = all.reduce((a, b) => Math.max(a, b));
    return Array.from({length: sizes[axis] + 1}, (_, i) => low + (i / sizes[axis]) * (high - low));
  });
  const point = (x, y, z) =>
    [0, 1, 2].map(
      (i) =>
        (m[i] * x + m[i + 4] * y + m[i + 8] * z + m[i + 12]) /
        (m[3] * x + m[7] * y + m[11] * z + m[15]),
    );
  const extinction = look.density.values[3] * ray.perDiagonal;
  const found = {shown: 0, less: 0, more: 0};
  for (let pixel = 0; pixel < width * height; ++pixel) {
    const [from, to] = [-1, 1].map((z) =>
      point(
        (2 * (pixel % width) + 1) / width - 1,
        (2 * Math.floor(pixel / width) + 1) / height - 1,
        z,
      ),
    );
    const along = to.map((value, axis) => value - from[axis]);
    const at = edges.map((all, axis) => all.map((place) => (place - from[axis]) / along[axis]));
    let shares = 0;
    for (const cube of cubes) {
      let enter = 0,
        leave = Infinity;
      for (let axis = 0; axis < 3; ++axis) {
        const a = at[axis][cube[axis]],
          b = at[axis][cube[axis] + 1];
        enter = Math.max(enter, Math.min(a, b));
        leave = Math.min(leave, Math.max(a, b));
      }
      shares += Math.max(0, leave - enter);
    }
    const wanted = 1 - Math.exp(-extinction * shares * Math.hypot(...along));
    const off = 255 * (drawn[4 * pixel + 3] - wanted);
    if (wanted > 0.02) ++found.shown;
    if (off < -2) ++found.less;
    if (off > 2) ++found.more;
  }
  return found;
}

/** Shows the box of cubes as a volume of constant opacity, without cards. */
async function openSponge(context) {
  const {server, browser} = context;
  const sizes = [kSponge, 2 * kSponge, 3 * kSponge];
  const cubes = [];
  for (let z = 0; z < sizes[2]; ++z)
    for (let y = 0; y < sizes[1]; ++y)
      for (let x = 0; x < sizes[0]; ++x) if (isInSponge(x, y, z)) cubes.push([x, y, z]);
  await serveMesh(context, 'sponge', linearBox(kSponge, {}, isInSponge));
  const viewer = await browser.open(
    `${server.url}?mesh=sponge&field=x&volume=0.3,0.3`,
    {...kScene, deviceScaleFactor: 1.5},
    hides('panel', 'legend'),
  );
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  return {viewer, compare: (camera) => comparedFrom(viewer, camera, sizes, cubes)};
}

async function comparedFrom(viewer, camera, sizes, cubes) {
  await viewer.page.evaluate((place) => window.qtetViewer.setAttribute('camera', place), camera);
  await viewer.restVolume();
  const {shown, less, more} = await viewer.inView(compareWithCubes, sizes, cubes);
  return {
    shown,
    wrong: less + more,
    note: `of ${shown} pixels ${less} show too little, ${more} too much`,
  };
}

/** Checks the whole picture from each of the cameras. */
async function looksRightFrom(cameras, tools, picture) {
  const {viewer, compare} = await openSponge(tools);
  const notes = [];
  for (const camera of cameras) {
    const {shown, wrong, note} = await compare(camera);
    notes.push(note);
    assert.ok(shown > 20000, note);
    assert.ok(wrong <= 2, notes.join('; '));
  }
  await viewer.screenshot(picture);
  assert.deepEqual(viewer.problems, []);
  return notes.join('; ');
}

/**
 * Many edges where rays leave the mesh on one side and stay in it on the other. No ray may enter
 * again too rarely or too often.
 */
const castsRaysBesideEdges = (tools) =>
  looksRightFrom(['2.6,3.2,1.7,0,0,0', '-1.9,2.7,2.4,0,0.1,0'], tools, 'volume-sponge');

/**
 * The eye is just outside of the mesh, nearer to a face than the canvas's near plane. The rays
 * begin at that plane.
 */
const castsRaysFromCloseToAFace = (tools) =>
  looksRightFrom(
    ['0.2703,0.1,0.1,0,0.05,0', '0.2693,-0.3,0.5,0.2,0.3,-0.2', '0.05,-0.5375,0.15,0,0,0'],
    tools,
    'volume-close',
  );

export const edgeChecks = {castsRaysBesideEdges, castsRaysFromCloseToAFace};
