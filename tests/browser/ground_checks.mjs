// The ground behind the mesh, and the cell that is pointed at.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {kCoarsePhone, kDesktop} from './browser.mjs';
import {readPng} from './png.mjs';

const opened = ({server, browser}, query, device) =>
  browser.openSettled(`${server.url}?${query}`, device);

/** The colour beside the mesh, and the brightness of the numbers there. */
async function groundOf(viewer, name) {
  const {width, height, at} = await viewer.screenshot(name);
  const ink = await viewer.page.evaluate(() => {
    const {shadowRoot} = window.qtetViewer;
    const channels = getComputedStyle(shadowRoot.querySelector('.ruler')).color.match(/\d+/g);
    return channels.slice(0, 3).reduce((sum, value) => sum + Number(value), 0) / 3;
  });
  return {color: at(Math.round(0.03 * width), Math.round(0.5 * height)), ink};
}

const brightness = (color) => color.reduce((sum, value) => sum + value) / 3;

/** Each ground has inks that are read on it, whatever the page's scheme is. */
async function choosesAGround(context) {
  for (const colorScheme of ['light', 'dark'])
    for (const [device, its] of Object.entries({desktop: kDesktop, phone: kCoarsePhone})) {
      const viewer = await opened(context, 'mesh=fin&axes=on', {...its, colorScheme});
      const {page} = viewer;
      for (const ground of ['light', 'dark', 'white', '204060', null]) {
        await page.evaluate((text) => {
          if (text === null) window.qtetViewer.removeAttribute('ground');
          else window.qtetViewer.setAttribute('ground', text);
        }, ground);
        await viewer.settle();
        const name = `ground-${device}-${colorScheme}-${ground}`;
        const {color, ink} = await groundOf(viewer, name);
        const isDark = ground === null ? colorScheme === 'dark' : /dark|20/.test(ground);
        assert.ok(brightness(color) < 128 === isDark, `${name}: ${color}`);
        assert.ok(ink > 128 === isDark, `${name}: ink ${ink}`);
        if (ground === '204060') assert.deepEqual([...color], [0x20, 0x40, 0x60]);
        if (ground === 'white') assert.deepEqual([...color], [255, 255, 255]);
      }
      assert.deepEqual(await viewer.accessibilityViolations(), []);
      assert.deepEqual(viewer.problems, []);
      await context.browser.closePages();
    }
  const viewer = await opened(context, 'mesh=box');
  const {page} = viewer;
  await page.locator('qtet-viewer summary', {hasText: 'View'}).click();
  const select = page.locator('qtet-viewer select[name=ground]');
  await select.selectOption('Own');
  await page.getByLabel('Colour of the ground').fill('#3c0000');
  await page.waitForURL(/ground=3c0000/);
  await select.selectOption('As the page');
  assert.ok(await page.getByLabel('Colour of the ground').isHidden());
  assert.equal(await page.evaluate(() => window.qtetViewer.getAttribute('ground')), null);
  await page.locator('qtet-viewer .scene').focus();
  await page.keyboard.press('Control+z');
  assert.match(await page.evaluate(() => window.qtetViewer.getAttribute('ground')), /^\w{6}$/);
  await page.evaluate(() => window.qtetViewer.setAttribute('ground', 'drak'));
  assert.match(await viewer.text('.notice p'), /ground="drak" is not understood.*dark/);
}

/** A chosen ground is there with the first picture, and in saved ones. The page's own stays. */
async function savesItsGround(context) {
  const viewer = await opened(context, 'mesh=box&ground=204060', kDesktop);
  const {page} = viewer;
  const corner = await page.evaluate(async () => {
    const picture = await createImageBitmap(await window.qtetViewer.picture());
    const canvas = new OffscreenCanvas(1, 1).getContext('2d');
    canvas.drawImage(picture, 0, 0);
    return [...canvas.getImageData(0, 0, 1, 1).data];
  });
  assert.deepEqual(corner, [0x20, 0x40, 0x60, 255]);
  await page.getByRole('button', {name: 'Save picture'}).click();
  const dialog = page.getByRole('dialog', {name: 'Save picture'});
  await dialog.getByText('As seen', {exact: true}).click();
  const saved = page.waitForEvent('download');
  await dialog.getByRole('button', {name: 'Save', exact: true}).click();
  const {at} = readPng(readFileSync(await (await saved).path()));
  assert.deepEqual([...at(1, 1)].slice(0, 3), [0x20, 0x40, 0x60]);
  await page.keyboard.press('Escape');
  const back = await page.evaluate(() => {
    const {style} = window.qtetViewer;
    style.setProperty('--back', 'rgb(1, 2, 3)');
    window.qtetViewer.setAttribute('ground', 'white');
    const own = getComputedStyle(window.qtetViewer).backgroundColor;
    window.qtetViewer.removeAttribute('ground');
    return [own, getComputedStyle(window.qtetViewer).backgroundColor];
  });
  assert.deepEqual(back, ['rgb(255, 255, 255)', 'rgb(1, 2, 3)']);
  assert.deepEqual(viewer.problems, []);
}

/** The cell under a pointer that rests has an outline, and that of a card keeps one. */
async function outlinesTheCell(context) {
  const viewer = await opened(context, 'mesh=box&clip=none');
  const {page} = viewer;
  const {x, y} = await page.evaluate(() => {
    const {bounds} = window.qtetViewer.viewing.mesh.base;
    const middle = [0, 1, 2].map((axis) => (bounds[axis] + bounds[axis + 3]) / 2);
    return window.qtetViewer.meshView.project(middle);
  });
  const cells = page.locator('qtet-viewer .layer path');
  assert.equal(await cells.count(), 0);
  await page.mouse.move(x, y);
  await cells.first().waitFor({state: 'attached'});
  await viewer.screenshot('ground-hovered');
  const box = await cells.first().boundingBox();
  assert.ok(box.x <= x && x <= box.x + box.width, JSON.stringify({x, box}));
  assert.ok(box.y <= y && y <= box.y + box.height, JSON.stringify({y, box}));
  assert.ok(box.width < 300 && box.height < 300, JSON.stringify(box));
  await page.mouse.move(x, y + 1);
  await page.waitForFunction(
    () => window.qtetViewer.shadowRoot.querySelectorAll('.layer path').length === 0,
  );
  await page.getByText('Point', {exact: true}).click();
  await page.mouse.click(x, y);
  await page.locator('qtet-viewer .result').waitFor();
  await page.mouse.move(2, 2);
  await viewer.settle();
  assert.equal(await cells.count(), 1);
  const before = await cells.first().getAttribute('d');
  await page.locator('qtet-viewer .scene').focus();
  await page.keyboard.press('ArrowLeft');
  await viewer.settle();
  assert.notEqual(await cells.first().getAttribute('d'), before);
  await page.getByRole('button', {name: 'Close', exact: true}).first().click();
  assert.equal(await cells.count(), 0);
  assert.deepEqual(viewer.problems, []);
}

export const groundChecks = {
  groundIsChosen: choosesAGround,
  groundIsSaved: savesItsGround,
  groundOutlinesTheCell: outlinesTheCell,
};
