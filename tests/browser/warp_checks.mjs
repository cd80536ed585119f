// The deformed shape: a field of vectors moves the mesh, and everything that is made of it.

import assert from 'node:assert/strict';
import {join} from 'node:path';
import {differingShare, readPng} from './png.mjs';
import {makeLog, serveMesh} from './programs.mjs';
import {linearBox} from './volume_checks.mjs';

async function opened({server, browser}, query) {
  const viewer = await browser.open(query.startsWith('http') ? query : `${server.url}?${query}`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  await viewer.waitForLines();
  return viewer;
}

/** The picture left of the panel. */
const pictureOf = async ({page, out}, name) =>
  readPng(
    await page.screenshot({
      path: join(out, `${name}.png`),
      clip: {x: 0, y: 0, width: 950, height: 800},
    }),
  );

/** The note in the legend takes room when it comes. */
async function refit(viewer) {
  await viewer.page.evaluate(() => window.qtetViewer.resetView());
  await viewer.settle();
}

const parameter = ({page}, name) => new URL(page.url()).searchParams.get(name);

/** The picture's bounds and those at rest, in the mesh's own unit, and the warp. */
const shapeOf = ({page}) =>
  page.evaluate(() => {
    const {manifest, snapshot} = window.qtetViewer.viewing.mesh;
    const {origin, step} = manifest.lattice;
    const placed = (bounds) => bounds?.map((end, i) => origin[i % 3] + step * end);
    const {bounds, warp} = snapshot;
    const field = warp && manifest.fields[warp.field].name;
    return {bounds: placed(bounds), rest: placed(warp?.restBounds), field, scale: warp?.scale};
  });

/** The way from rest and the displacement of the place in the middle of the picture. */
const middleOf = ({page}) =>
  page.evaluate(async () => {
    const {meshView, viewing} = window.qtetViewer;
    const {fields} = viewing.mesh.manifest;
    const {clientWidth, clientHeight} = meshView.canvas;
    // cards cover the right
    const pick = await viewing.client.pick(meshView.rayAt(0.38 * clientWidth, clientHeight / 2));
    return {
      way: pick.rest.position.map((x, i) => pick.position[i] - x),
      vector: pick.fields.find(({field}) => fields[field].name === 'Displacement').values,
    };
  });

/** A beam that bends by more than an edge is deformed; a switch and a link leave it at rest. */
async function isDeformedWhereItPassesAnEdge(context) {
  const {server, bin, out} = context;
  makeLog(bin, 'beam', out);
  server.kill();
  await server.start();
  const viewer = await opened(context, 'mesh=beam');
  assert.deepEqual((({field, scale}) => [field, scale])(await shapeOf(viewer)), [
    'Displacement',
    1,
  ]);
  await viewer.page.getByRole('switch', {name: 'Deformed shape'}).click();
  await viewer.settle();
  assert.equal(parameter(viewer, 'warp'), 'off');
  assert.equal((await shapeOf(viewer)).field, undefined);
  const again = await opened(context, viewer.page.url());
  assert.equal((await shapeOf(again)).field, undefined);
  await viewer.page.getByRole('switch', {name: 'Deformed shape'}).click();
  await viewer.settle();
  assert.equal(parameter(viewer, 'warp'), null);
  assert.equal((await shapeOf(viewer)).field, 'Displacement');
  assert.deepEqual([...viewer.problems, ...again.problems], []);
}

/** A run that begins at rest opens at an instant that shows something, and plays on from there. */
async function opensARunWhereItShowsMost(context) {
  const {server, bin, out} = context;
  makeLog(bin, 'beam-run', out, ['beam', '--steps', '24']);
  server.kill();
  await server.start();
  const viewer = await opened(context, 'mesh=beam-run');
  const {page} = viewer;
  const timeOf = () =>
    page.evaluate(() => {
      const {manifest, snapshot} = window.qtetViewer.viewing.mesh;
      const {color, warp} = snapshot;
      return [color, warp].map((its) => manifest.fields[its.field].instant.time);
    });
  const [time, moved] = await timeOf();
  assert.ok(time > 0, `it opens at ${time}`);
  assert.equal(moved, time);
  assert.equal(parameter(viewer, 'time'), null);
  assert.equal(
    await viewer.page.locator('qtet-viewer input[name=instant]').inputValue(),
    `${time}`,
  );
  await pictureOf(viewer, 'series-opening');
  await page.locator('qtet-viewer .scene').focus();
  await page.keyboard.press('.');
  await viewer.settle();
  assert.ok((await timeOf())[0] !== time, 'the next instant is the same');
  await page.keyboard.press(',');
  await viewer.settle();
  assert.equal((await timeOf())[0], time);
  assert.equal(parameter(viewer, 'time'), null);
  const rest = await opened(context, 'mesh=beam-run&time=0');
  assert.deepEqual(await rest.page.locator('qtet-viewer input[name=instant]').inputValue(), '0');
  assert.deepEqual([...viewer.problems, ...rest.problems], []);
}

/** A switch and a number deform a beam. A link shows the same, and undo goes back. */
async function deformsABeam(context) {
  const {server, bin, out} = context;
  makeLog(bin, 'beam', out);
  server.kill();
  await server.start();
  const viewer = await opened(context, 'mesh=beam&field=VonMises&warp=off');
  const {page} = viewer;
  const plain = await pictureOf(viewer, 'warp-off');
  await page.getByRole('switch', {name: 'Deformed shape'}).click();
  await viewer.settle();
  assert.equal(parameter(viewer, 'warp'), null);
  assert.equal(await viewer.text('.legend-warp'), 'Deformed shape ×\u202f1');
  const number = page.getByRole('textbox', {name: 'Scale ×'});
  await number.fill('8');
  await number.press('Enter');
  await viewer.settle();
  assert.equal(parameter(viewer, 'warp-scale'), '8');
  await refit(viewer);
  const moved = await pictureOf(viewer, 'warp-on');
  assert.ok(differingShare(plain, moved) > 0.05, 'the shape does not change');

  const {bounds, rest, field, scale} = await shapeOf(viewer);
  assert.deepEqual([field, scale], ['Displacement', 8]);
  const sag = rest[2] - bounds[2];
  assert.ok(Math.abs(sag - 8 * 0.1952) < 0.01, `the beam sags by ${sag}`);
  const {way, vector} = await middleOf(viewer);
  way.forEach((x, i) =>
    assert.ok(Math.abs(x - 8 * vector[i]) < 0.002, `${way} is not 8 times ${vector}`),
  );
  assert.ok(Math.hypot(...way) > 0.1, `the middle moves by ${way}`);

  const lineCount = () =>
    viewer.inView(({scene}) => (scene.parts.restEdges?.lines.length ?? 0) / 6);
  assert.equal(await lineCount(), 0);
  await page.getByRole('switch', {name: 'Edges at rest'}).click();
  await viewer.settle();
  assert.equal(parameter(viewer, 'rest-edges'), 'on');
  assert.ok((await lineCount()) > 0, 'no edges at rest');
  const lined = await pictureOf(viewer, 'warp-rest-edges');
  assert.ok(differingShare(moved, lined) > 0.002, 'the edges at rest are not seen');

  const again = await opened(context, page.url());
  assert.ok(differingShare(lined, await pictureOf(again, 'warp-link')) < 0.002, 'a link differs');
  await page.locator('qtet-viewer .scene').focus();
  for (let i = 0; i < 3; ++i) await page.keyboard.press('Control+z');
  await viewer.settle();
  await refit(viewer);
  assert.equal(parameter(viewer, 'warp'), 'off');
  for (const name of ['warp-scale', 'rest-edges']) assert.equal(parameter(viewer, name), null);
  assert.ok(differingShare(plain, await pictureOf(viewer, 'warp-undone')) < 0.002, 'undo differs');
  assert.deepEqual([...viewer.problems, ...again.problems], []);
}

/** The instant of the time bar moves the mesh: cuts and isosurfaces as well as the surface. */
async function playsAMotion(context) {
  const pull = (far) => (x, y, z) => [far * z, 0, 0];
  await serveMesh(
    context,
    'pulled',
    linearBox(3, {'Displacement@0': pull(0), 'Displacement@1': pull(0.5)}),
  );
  const viewer = await opened(context, 'mesh=pulled&field=x&warp=Displacement&clip=y:0.5');
  const {page} = viewer;
  const shapes = [await shapeOf(viewer)];
  await page.evaluate(() => window.qtetViewer.setAttribute('time', '1'));
  await page.waitForFunction(() => window.qtetViewer.viewing.mesh.snapshot.warp.field === 2, null);
  await viewer.settle();
  await pictureOf(viewer, 'warp-series');
  shapes.push(await shapeOf(viewer));
  assert.deepEqual(
    shapes.map(({field, bounds}) => [field, Number(bounds[3].toFixed(2))]),
    [
      ['Displacement@0', 1],
      ['Displacement@1', 2.5],
    ],
  );
  await page.getByRole('button', {name: 'Play', exact: true}).click();
  for (const time of [0, 1])
    await page.waitForFunction(
      (its) => {
        const {manifest, snapshot} = window.qtetViewer.viewing.mesh;
        return manifest.fields[snapshot.warp.field].instant.time === its;
      },
      time,
      {polling: 10},
    );
  assert.deepEqual(viewer.problems, []);
}

/** The cube leaves its corner to a warped mesh that leans into it. */
async function keepsTheCubeBesideAWarpedMesh(context) {
  const {server} = context;
  for (const [name, lean] of [
    ['left', -1.2],
    ['right', 1.2],
  ]) {
    const Displacement = (x, y, z) => [lean * (z - 1.5), 0, 0];
    await serveMesh(context, `leaning-${name}`, linearBox(3, {Displacement}));
    const viewer = await opened({...context, server}, `mesh=leaning-${name}&warp=off&clip=none`);
    const {page} = viewer;
    const sideOf = async () => {
      await page.evaluate(() => window.qtetViewer.look('-y'));
      await viewer.settle();
      const box = await page.locator('qtet-viewer .orientation-cube').boundingBox();
      return box.x < 400 ? 'left' : 'right';
    };
    assert.equal(await sideOf(), 'left');
    await page.evaluate(() => window.qtetViewer.setAttribute('warp', 'Displacement'));
    await page.evaluate(() => window.qtetViewer.setAttribute('warp-scale', '1'));
    await viewer.settle();
    const side = await sideOf();
    await viewer.screenshot(`cube-beside-${name}`);
    assert.equal(side, name === 'left' ? 'right' : 'left', `the mesh leans to the ${name}`);
    assert.deepEqual(viewer.problems, []);
  }
}

export const warpChecks = {
  keepsTheCubeBesideAWarpedMesh,
  deformsABeam,
  isDeformedWhereItPassesAnEdge,
  opensARunWhereItShowsMost,
  playsAMotion,
};
