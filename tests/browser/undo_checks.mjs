// Undo and redo by real keys.

import assert from 'node:assert/strict';
import {kSmallDesktop} from './browser.mjs';

const attribute = (viewer, name) =>
  viewer.page.evaluate((its) => window.qtetViewer.getAttribute(its), name);

/** Presses the keys and returns the status line. */
async function press(viewer, keys) {
  await viewer.page.keyboard.press(keys);
  await viewer.settle();
  return viewer.page.locator('qtet-viewer .live').textContent();
}

async function undoesSettingsAndTheCamera({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=box&clip=y:0.5`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  await page.getByRole('button', {name: 'View from +x'}).waitFor();
  const pages = await page.evaluate(() => history.length);
  const focus = () => page.locator('qtet-viewer canvas.scene').focus();

  await focus();
  assert.equal(await press(viewer, 'Control+z'), 'Nothing to undo');
  await page.getByRole('radio', {name: 'Turbo'}).check({force: true});
  await viewer.settle();
  // one drag of a slider, with rests, is one step
  const slider = page.locator('qtet-viewer input[name=opacity]');
  await slider.scrollIntoViewIfNeeded();
  const {x, y, width, height} = await slider.boundingBox();
  await page.mouse.move(x + width - 8, y + height / 2);
  await page.mouse.down();
  for (const share of [0.8, 0.6, 0.4]) {
    await page.mouse.move(x + share * width, y + height / 2, {steps: 4});
    await page.waitForTimeout(400);
  }
  await page.mouse.up();
  await viewer.settle();
  const opacity = await attribute(viewer, 'opacity');
  assert.ok(Number(opacity) < 0.6, `opacity ${opacity}`);
  await focus();
  await page.keyboard.press('ArrowLeft');
  await viewer.settle();
  const camera = await page.evaluate(() => window.qtetViewer.cameraState);

  assert.equal(await press(viewer, 'Control+z'), 'Undone: camera');
  const before = await page.evaluate(() => window.qtetViewer.cameraState);
  assert.notDeepEqual(before, camera);
  assert.equal(await press(viewer, 'Control+z'), 'Undone: opacity');
  assert.equal(await attribute(viewer, 'opacity'), null);
  await viewer.screenshot('undone');
  assert.equal(await press(viewer, 'Meta+z'), 'Undone: colour map');
  assert.equal(await attribute(viewer, 'colormap'), null);
  assert.equal(await press(viewer, 'Control+z'), 'Nothing to undo');
  assert.equal(await attribute(viewer, 'clip'), 'y:0.5');
  assert.equal(await press(viewer, 'Control+Shift+z'), 'Redone: colour map');
  assert.equal(await press(viewer, 'Control+y'), 'Redone: opacity');
  assert.equal(await attribute(viewer, 'opacity'), opacity);
  assert.equal(await press(viewer, 'Control+y'), 'Redone: camera');
  const after = await page.evaluate(() => window.qtetViewer.cameraState);
  after.forEach((value, i) => assert.ok(Math.abs(value - camera[i]) < 1e-3, `${after}`));
  assert.equal(await press(viewer, 'Control+y'), 'Nothing to redo');
  assert.equal(await page.evaluate(() => history.length), pages);
  assert.deepEqual(viewer.problems, []);
}

/** Isosurfaces and what their switch changes besides come and go in one step. */
async function undoesIsosurfacesInOneStep({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin`, kSmallDesktop);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  await page.getByRole('button', {name: 'View from +x'}).waitFor();
  await viewer.settle();
  const look = () =>
    page.evaluate(() => {
      const {settings, mesh} = window.qtetViewer.viewing;
      const {opacity, planes} = settings;
      return {opacity, planes, iso: mesh.snapshot.isosurface?.count ?? null};
    });
  const before = await look();
  await page.locator('qtet-viewer input[name=iso]').evaluate((its) => its.click());
  await viewer.settle();
  assert.notEqual(await attribute(viewer, 'iso'), null);
  assert.equal((await look()).opacity, before.opacity);
  await viewer.screenshot('isosurfaces-on');
  await page.locator('qtet-viewer canvas.scene').focus();
  assert.equal(await press(viewer, 'Control+z'), 'Undone: isosurfaces');
  assert.equal(await attribute(viewer, 'iso'), null);
  assert.deepEqual(await look(), before);
  assert.equal(await press(viewer, 'Control+z'), 'Nothing to undo');
  assert.deepEqual(viewer.problems, []);
}

/** In a text box the keys are the browser's. */
async function leavesTextBoxesTheirOwnUndo({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=box&range=0,1`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  await page.getByRole('button', {name: 'View from +x'}).waitFor();
  await page.getByRole('radio', {name: 'Turbo'}).check({force: true});
  await viewer.settle();
  const box = page.locator('qtet-viewer input[name=range-high]');
  await box.click();
  await page.keyboard.type('7');
  await page.keyboard.press('Control+z');
  await viewer.settle();
  assert.equal(await box.inputValue(), '1');
  assert.equal(await attribute(viewer, 'colormap'), 'turbo');
}

export const undoChecks = {
  undoesSettingsAndTheCamera,
  undoesIsosurfacesInOneStep,
  leavesTextBoxesTheirOwnUndo,
};
