// The lines on surfaces and cuts: creases of a part, and where a plane meets the surface. A smooth
// body has none.

import assert from 'node:assert/strict';
import {hides, kScene} from './browser.mjs';
import {largestDifference} from './png.mjs';
import {serveMesh} from './programs.mjs';
import {linearBox} from './volume_checks.mjs';

/** Places along an edge, as shares of it. */
const kPlaces = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9];
/** A line changes the luminance by at least this share. */
const kContrast = 0.2;

async function opened({server, browser}, query, device = kScene) {
  const viewer = await browser.open(`${server.url}?${query}`, device, hides('panel', 'legend'));
  await viewer.waitForState(query.includes('quality') ? 'held' : 'complete');
  await viewer.waitForPicture();
  await viewer.waitForLines();
  return viewer;
}

/** The picture with lines and without. */
async function bothPictures(viewer, name) {
  const pictures = [];
  for (const creases of ['on', 'off']) {
    await viewer.page.evaluate((its) => window.qtetViewer.setAttribute('creases', its), creases);
    await viewer.settle();
    pictures.push(await viewer.screenshot(`${name}-${creases}`));
  }
  return pictures;
}

/** The places of points on the screen; the points are shares of the mesh's bounds. */
const onScreen = (viewer, points) =>
  viewer.page.evaluate((its) => {
    const {meshView, viewing} = window.qtetViewer;
    const {left, top} = meshView.canvas.getBoundingClientRect();
    const {bounds} = viewing.mesh.base;
    return its.map((shares) => {
      const point = shares.map((share, i) => bounds[i] + share * (bounds[i + 3] - bounds[i]));
      const {x, y} = meshView.project(point);
      return {x: left + x, y: top + y};
    });
  }, points);

const luminance = ([red, green, blue]) => 0.2126 * red + 0.7152 * green + 0.0722 * blue;

/** The largest change by lines near a place, as a share of the luminance without them. */
function changeAt([lined, plain], {x, y}) {
  let most = 0;
  for (let dy = -1; dy <= 1; ++dy)
    for (let dx = -1; dx <= 1; ++dx) {
      const at = [Math.floor(x) + dx, Math.floor(y) + dy];
      const change = luminance(lined.at(...at)) / Math.max(1, luminance(plain.at(...at))) - 1;
      if (Math.abs(change) > Math.abs(most)) most = change;
    }
  return most;
}

/** The edges of a box that are lines from end to end: the least change along each. */
async function linesAmong(viewer, pictures, edges) {
  const changes = [];
  for (const [from, to] of edges) {
    const points = kPlaces.map((share) => from.map((x, i) => x + share * (to[i] - x)));
    const along = (await onScreen(viewer, points)).map((place) => changeAt(pictures, place));
    changes.push(along.reduce((least, x) => (Math.abs(x) < Math.abs(least) ? x : least)));
  }
  return changes.filter((change) => Math.abs(change) >= kContrast);
}

/** The twelve edges of the unit box. */
const kEdges = [0, 1, 2].flatMap((axis) =>
  [0, 1].flatMap((p) =>
    [0, 1].map((q) =>
      [0, 1].map((end) => {
        const point = [p, q];
        point.splice(axis, 0, end);
        return point;
      }),
    ),
  ),
);
/** Where the plane x = 0.5 meets it. */
const kOutline = kEdges
  .filter(([from, to]) => from[0] === 0 && to[0] === 0)
  .map((edge) => edge.map(([, y, z]) => [0.5, y, z]));

/**
 * The edges of a box are lines, darker than it or on a dark ground lighter, and so is the outline
 * of a cut. Nothing else changes.
 */
async function drawsTheEdgesOfABox(context) {
  const notes = [];
  for (const colorScheme of ['light', 'dark']) {
    const viewer = await opened(context, 'mesh=box&edges=off&clip=none', {
      ...kScene,
      colorScheme,
    });
    const pictures = await bothPictures(viewer, `creases-${colorScheme}`);
    const lines = await linesAmong(viewer, pictures, kEdges);
    // three are between sides that are seen
    assert.ok(lines.length >= 3, `${lines.length} edges are lines on a ${colorScheme} ground`);
    const sign = colorScheme === 'dark' ? 1 : -1;
    for (const change of lines) assert.equal(Math.sign(change), sign, `a line changes ${change}`);
    let changed = 0;
    const [a, b] = pictures;
    for (let y = 0; y < a.height; ++y)
      for (let x = 0; x < a.width; ++x) if (a.at(x, y).join() !== b.at(x, y).join()) ++changed;
    const share = changed / a.width / a.height;
    assert.ok(share < 0.02, `${share} of the picture are lines`);
    notes.push(`${lines.length} on a ${colorScheme} ground`);
  }
  const viewer = await opened(context, 'mesh=box&edges=off&clip=x:0.5');
  const pictures = await bothPictures(viewer, 'creases-cut');
  const lines = await linesAmong(viewer, pictures, kOutline);
  assert.ok(lines.length >= 2, `${lines.length} sides of a cut are lines`);
  return `${notes.join(', ')}, ${lines.length} round a cut`;
}

/** A ball: the box of linearBox, drawn in to the ball that it encloses. */
function ball(cells) {
  return linearBox(cells).replace(/(Name="Points"[^>]*>)([^<]*)/, (_, head, text) => {
    const numbers = text.split(' ').map(Number);
    const places = numbers.map((x, i) => (2 * x) / (1 + (i % 3)) - 1);
    const round = places.map((x, i) => {
      const place = places.slice(i - (i % 3), i - (i % 3) + 3);
      return (x * Math.max(...place.map(Math.abs))) / (Math.hypot(...place) || 1);
    });
    return `${head}${round.join(' ')}`;
  });
}

/** However coarse it is. */
async function drawsNoLinesOnABall(context) {
  await serveMesh(context, 'ball', ball(5));
  const counts = [];
  for (const quality of ['&quality=cells:150', '&quality=cells:2000', '']) {
    const viewer = await opened(context, `mesh=ball&edges=off&clip=none${quality}`);
    const difference = largestDifference(...(await bothPictures(viewer, 'creases-ball')));
    const {tetrahedra} = await viewer.statistics();
    assert.equal(difference, 0, `${tetrahedra} cells of a ball have lines`);
    counts.push(tetrahedra);
  }
  return `none among ${counts.join(', ')} cells`;
}

export const lineChecks = {drawsTheEdgesOfABox, drawsNoLinesOnABall};
