// Parts: the list, the picture and the address follow each other.

import assert from 'node:assert/strict';
import {kSmallDesktop} from './browser.mjs';
import {serveMesh} from './programs.mjs';
import {linearBox} from './volume_checks.mjs';

/** Longer than changes that are one step lie apart. */
const kStepMs = 400;
const kParts = 500;
/** Rows that exist at once: those in view and one that is half seen. */
const kMaxRows = 10;
/** Opening the list of all parts, and hiding one, on a busy machine. */
const kQuickMs = 3000;

/** A box of 1 x 2 x 3 in 500 parts, each of cubes that follow each other. */
function manyParts() {
  const n = 5;
  const cubes = 6 * n ** 3;
  const partOf = (cell) => 1 + Math.floor((Math.floor(cell / 6) * kParts) / cubes);
  const values = Array.from({length: 6 * cubes}, (_, cell) => partOf(cell)).join(' ');
  const names = Array.from({length: kParts}, (_, i) => {
    const name = `Part=Part ${String(i + 1).padStart(3, '0')}`;
    const start = `<DataArray type="Int32" Name="${name}" NumberOfTuples="1" format="ascii">`;
    return `${start}${i + 1}</DataArray>`;
  });
  const part = `<DataArray type="Int32" Name="Part" format="ascii">${values}</DataArray>`;
  return linearBox(n)
    .replace('<Points>', `<CellData>${part}</CellData><Points>`)
    .replace('<UnstructuredGrid>', `<UnstructuredGrid><FieldData>${names.join('')}</FieldData>`);
}

const attributes = (viewer) =>
  viewer.page.evaluate(() =>
    ['parts', 'hidden-parts', 'part-opacity'].map((name) => window.qtetViewer.getAttribute(name)),
  );

/** The volume of what is drawn. */
const volumeOf = (viewer) =>
  viewer.page.evaluate(async () => (await window.qtetViewer.client.numbers()).body.size);

async function partsFollowTheList(context) {
  const {server, browser} = context;
  await serveMesh(context, 'parts', manyParts());
  const address = `${server.url}?mesh=parts&clip=none&field=x`;
  const viewer = await browser.openComplete(address, kSmallDesktop);
  const {page} = viewer;
  const whole = await volumeOf(viewer);
  const rows = page.locator('qtet-viewer .part-row');
  const timed = async (act) => {
    const start = performance.now();
    await act();
    return Math.round(performance.now() - start);
  };
  const openMs = await timed(async () => {
    await page.locator('qtet-viewer summary', {hasText: /^Parts$/}).click();
    await rows.locator('.part-share', {hasText: '%'}).first().waitFor();
  });
  assert.ok((await rows.count()) <= kMaxRows, 'only rows in view exist');
  await page.getByLabel('Search parts').fill('part 007');
  const row = rows.filter({hasText: 'Part 007'});
  await row.click();
  const hideMs = await timed(async () => {
    await page.locator('qtet-viewer .part-rows').press('Space');
    await page.waitForFunction(() => window.qtetViewer.getAttribute('hidden-parts') !== null);
    await viewer.settle();
  });
  assert.deepEqual(await attributes(viewer), ['Part', 'Part 007', null]);
  const share = 1 - (await volumeOf(viewer)) / whole;
  assert.ok(share > 0.5 / kParts && share < 2 / kParts, `${share} of the volume is hidden`);
  assert.ok(openMs < kQuickMs && hideMs < kQuickMs, `${openMs} and ${hideMs} ms`);
  await page.waitForTimeout(kStepMs);
  await page.locator('qtet-viewer .part-rows').press('t');
  await viewer.settle();
  assert.deepEqual(await attributes(viewer), ['Part', 'Part 007', 'Part 007=0.3']);
  await page.waitForTimeout(kStepMs);
  await page.locator('qtet-viewer .scene').focus();
  for (let i = 0; i < 2; ++i) await page.keyboard.press('Control+z');
  await viewer.settle();
  assert.deepEqual(await attributes(viewer), [null, null, null]);
  assert.ok(Math.abs((await volumeOf(viewer)) / whole - 1) < 1e-9, 'all parts are back');

  // a click on the mesh selects its part
  const [x, y] = await page.evaluate(() => {
    const {view} = window.qtetViewer.viewing;
    const bounds = window.qtetViewer.viewing.mesh.base.bounds;
    const middle = [0, 1, 2].map((axis) => (bounds[axis] + bounds[axis + 3]) / 2);
    const at = view.project(middle);
    return [at.x, at.y];
  });
  await page.locator('qtet-viewer .scene').click({position: {x, y}});
  await page.locator('qtet-viewer .part-row.selected').waitFor();

  const alone = `${address}&parts=Part&hidden-parts=all%20but%20Part%20007,8`;
  const again = await browser.openComplete(alone, kSmallDesktop);
  await again.settle();
  const two = (await volumeOf(again)) / whole;
  assert.ok(two > 1 / kParts && two < 4 / kParts, `${two} of the volume is shown`);
  assert.equal(await again.page.locator('qtet-viewer .notice .message').count(), 0);
  return `${kParts} parts: open in ${openMs} ms, one hidden in ${hideMs} ms`;
}

export const partChecks = {partsFollowTheList};
