// The volume: against what a formula says of a box, and what a user does with it.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {kDesktop, kPhone} from './browser.mjs';
import {coloredShare, differingShare} from './png.mjs';

/** Box of 1 x 2 x 3 with the field x: n cubes along the shortest side, six tetrahedra each. */
function linearBox(n) {
  const sizes = [n, 2 * n, 3 * n];
  const id = (x, y, z) => (z * (sizes[1] + 1) + y) * (sizes[0] + 1) + x;
  const points = [];
  const cells = [];
  for (let z = 0; z <= sizes[2]; ++z) for (let y = 0; y <= sizes[1]; ++y) for (let x = 0; x <= sizes[0]; ++x) points.push([x / n, y / n, z / n]);
  const corner = (x, y, z, bits) => id(x + (bits & 1), y + ((bits >> 1) & 1), z + (bits >> 2));
  const sixths = [[1, 3], [3, 2], [2, 6], [6, 4], [4, 5], [5, 1]];
  for (let z = 0; z < sizes[2]; ++z) for (let y = 0; y < sizes[1]; ++y) for (let x = 0; x < sizes[0]; ++x) {
    for (const [p, q] of sixths) cells.push([0, p, q, 7].map((bits) => corner(x, y, z, bits)));
  }
  const array = (type, name, values, components = 1) =>
    `<DataArray type="${type}" Name="${name}" NumberOfComponents="${components}" format="ascii">${values.join(' ')}</DataArray>`;
  return `<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="${points.length}" NumberOfCells="${cells.length}"><PointData>${array('Float32', 'x', points.map(([x]) => x))}</PointData>
<Points>${array('Float32', 'Points', points.flat(), 3)}</Points><Cells>${array('Int64', 'connectivity', cells.flat())}
${array('Int64', 'offsets', cells.map((_, i) => 4 * i + 4))}${array('UInt8', 'types', cells.map(() => 10))}</Cells></Piece></UnstructuredGrid></VTKFile>`;
}

/** RGBA in 0..255 where the lattice's points (shares of the box) come to lie, out of a picture with all its pixels. */
function pixelsAt(viewer, places) {
  return viewer.page.evaluate((shares) => {
    const {meshView} = window.qtetViewer;
    const {bounds, canvas} = meshView;
    void meshView.picture('#fff');  // draws at once
    const gl = canvas.getContext('webgl2');
    return shares.map((share) => {
      const {x, y} = meshView.project(share.map((s, axis) => bounds[axis] + s * (bounds[axis + 3] - bounds[axis])));
      const pixel = new Uint8Array(4);
      gl.readPixels(Math.round(x * canvas.width / canvas.clientWidth), Math.round(canvas.height - y * canvas.height / canvas.clientHeight), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      return [...pixel];
    });
  }, places);
}

/** A picture at rest, in the cells' right order. */
async function rest(viewer) {
  await viewer.page.waitForFunction(() => {
    const {meshView} = window.qtetViewer;
    return meshView.volume.visible && meshView.sortedFor && !meshView.budget.busy;
  });
  await viewer.settle();
}

async function drawsAVolumeAsTheFormulaSays({server, browser, logs, out, bin}) {
  const mesh = join(out, 'linear.vtu');
  writeFileSync(mesh, linearBox(4));
  execFileSync(join(bin, 'qtet'), ['simplify', mesh, '-o', join(logs.fin.folder, 'linear.qtet')], {stdio: 'pipe'});
  server.kill();
  await server.start();
  const kOpacity = 0.3, kPath = 0.1;  // the last of the opacities, and of what share of the diagonal it is told
  const extinction = -Math.log(1 - kOpacity) / kPath / Math.hypot(1, 2, 3);
  const viewer = await browser.open(`${server.url}?mesh=linear&field=x&volume=0,${kOpacity}&projection=parallel&colormap=grey`);
  await viewer.waitForState('complete');
  const notes = [];
  const expectClose = (pixels, depths, what) => pixels.forEach(([, , , alpha], i) => {
    const expected = 255 * (1 - Math.exp(-depths[i]));
    notes.push(Math.abs(alpha - expected));
    assert.ok(Math.abs(alpha - expected) < 2, `${what}: ${alpha} instead of ${expected.toFixed(1)} (${JSON.stringify(pixels)})`);
  });
  const look = async (direction) => {
    await viewer.page.evaluate((way) => window.qtetViewer.look(way), direction);
    await rest(viewer);
  };
  const at = [0.13, 0.4, 0.62, 0.9];
  await look('-y');  // along y, 2 long, the value stays what it is
  expectClose(await pixelsAt(viewer, at.map((x) => [x, 0.5, 0.37])), at.map((x) => extinction * x * 2), 'along the level sets');
  await look('+x');  // along x, 1 long, it goes from 0 to 1
  expectClose(await pixelsAt(viewer, at.map((z) => [0.5, 0.3, z])), at.map(() => extinction / 2), 'across the level sets');
  await viewer.page.evaluate(() => window.qtetViewer.setAttribute('clip', 'x:0.6'));
  await rest(viewer);
  const [low, high] = await viewer.page.evaluate(() => [0, 3].map((i) => window.qtetViewer.meshView.bounds[i]));
  const cut = (Math.floor(low + 0.6 * (high - low)) + 0.5 - low) / (high - low);
  expectClose(await pixelsAt(viewer, at.map((z) => [0.2, 0.7, z])), at.map(() => (extinction * cut * cut) / 2), 'clipped');
  await viewer.screenshot('volume-linear');
  assert.deepEqual(viewer.problems, []);
  return `${notes.length} pixels, at most ${Math.max(...notes).toFixed(2)} of 255 off`;
}

async function editsTheTransferFunction({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&quality=cells:20000`, {...kDesktop, colorScheme: 'dark'});
  await viewer.waitForState('held');
  await viewer.waitForPicture();
  const {page} = viewer;
  const surface = await viewer.screenshot('volume-off');
  await page.getByRole('switch', {name: 'Volume'}).check();
  await rest(viewer);
  const first = await viewer.screenshot('volume');
  assert.ok(differingShare(surface, first) > 0.02 && coloredShare(first) > 0.02, 'the volume is not to be seen');
  await page.getByRole('button', {name: 'Denser'}).click();
  await page.getByRole('slider', {name: 'Opacity at 13 % of the range'}).focus();
  for (let i = 0; i < 20; ++i) await page.keyboard.press('ArrowUp');
  await rest(viewer);
  assert.ok(differingShare(first, await viewer.screenshot('volume-denser')) > 0.02, 'the sliders change nothing');
  assert.match(new URL(page.url()).searchParams.get('volume'), /^0,0\.2\d*,/);
  await page.locator('qtet-viewer .scene').focus();
  for (let i = 0; i < 10; ++i) await page.keyboard.press('ArrowLeft');
  await rest(viewer);
  await viewer.screenshot('volume-turned');
  await page.getByRole('switch', {name: 'Volume'}).uncheck();
  await viewer.settle();
  const phone = await browser.open(`${server.url}?mesh=fin&quality=cells:20000&volume=0,0.2,0.6`, kPhone);
  await phone.waitForState('held');
  await phone.waitForPicture();
  await rest(phone);
  await phone.page.getByRole('button', {name: 'Controls'}).tap();
  await phone.page.locator('qtet-viewer .volume').scrollIntoViewIfNeeded();
  await phone.settle();
  await phone.screenshot('volume-phone');
  assert.deepEqual([...viewer.problems, ...phone.problems], []);
}

export const volumeChecks = {drawsAVolumeAsTheFormulaSays, editsTheTransferFunction};
