// Pictures to publish: made, saved, copied, and dropped to open their view again.

import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {kCoarsePhone, kSmallDesktop} from './browser.mjs';
import {coloredShare, readPng} from './png.mjs';

const opened = ({server, browser}, query, device) =>
  browser.openComplete(`${server.url}?${query}`, device);

/** Opens the dialog, fills it, and returns the file of the picture. */
export async function picture(viewer, name, {width, height, ground = 'White', title, unit}) {
  const {page} = viewer;
  await page.getByRole('button', {name: 'Save picture'}).click();
  const dialog = page.getByRole('dialog', {name: 'Save picture'});
  await dialog.waitFor();
  await dialog.getByRole('textbox', {name: 'Width'}).fill(String(width));
  await dialog.getByRole('textbox', {name: 'Height'}).fill(String(height));
  await dialog.getByRole('radio', {name: ground}).check({force: true});
  if (title !== undefined) await dialog.getByRole('textbox', {name: 'Title'}).fill(title);
  if (unit !== undefined) await dialog.getByRole('textbox', {name: 'Unit'}).fill(unit);
  await viewer.screenshot(`${name}-dialog`);
  const saved = page.waitForEvent('download');
  await dialog.getByRole('button', {name: 'Save', exact: true}).click();
  const file = readFileSync(await (await saved).path());
  writeFileSync(join(viewer.out, `${name}.png`), file);
  await dialog.waitFor({state: 'hidden'});
  return file;
}

/** The bounds of the coloured pixels above the legend, as shares: left, right, top, bottom. */
function meshBounds({width, height, at, alphaAt}) {
  const bounds = [1, 0, 1, 0];
  for (let y = Math.round(0.1 * height); y < 0.85 * height; y += 2) {
    for (let x = 0; x < width; x += 2) {
      const rgb = at(x, y);
      if (alphaAt(x, y) < 255 || Math.max(...rgb) - Math.min(...rgb) < 40) continue;
      // the axes stand in the corner
      if (x < 0.1 * width && y > 0.75 * height) continue;
      bounds[0] = Math.min(bounds[0], x / width);
      bounds[1] = Math.max(bounds[1], x / width);
      bounds[2] = Math.min(bounds[2], y / height);
      bounds[3] = Math.max(bounds[3], y / height);
    }
  }
  return bounds;
}

/** Whether a column of the lower seventh has an opaque pixel of about this colour. */
function hasBelow({height, at, alphaAt}, x, color) {
  for (let y = Math.round(0.86 * height); y < height; ++y) {
    if (alphaAt(x, y) === 255 && at(x, y).every((value, c) => Math.abs(value - color[c]) < 16))
      return true;
  }
  return false;
}

/** Drops a file on the viewer. */
const drop = (viewer, file) =>
  viewer.page.evaluate((base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([bytes], 'dropped.png', {type: 'image/png'}));
    const event = {dataTransfer, bubbles: true, cancelable: true};
    const [over, dropped] = ['dragover', 'drop'].map((type) => new DragEvent(type, event));
    window.qtetViewer.dispatchEvent(over);
    window.qtetViewer.dispatchEvent(dropped);
    return over.defaultPrevented && dropped.defaultPrevented;
  }, file.toString('base64'));

const cameraOf = (viewer) => viewer.page.evaluate(() => window.qtetViewer.cameraState);
const attributes = (viewer, ...names) =>
  viewer.page.evaluate((its) => its.map((name) => window.qtetViewer.getAttribute(name)), names);

/** The mesh is in the middle between title and legend, whatever lies over the canvas. */
async function makesAPictureToPublish(context) {
  const viewer = await opened(context, 'mesh=fin&field=Density&clip=none');
  const before = await cameraOf(viewer);
  const shot = await picture(viewer, 'picture-transparent', {
    width: 3000,
    height: 2000,
    ground: 'Transparent',
    title: 'Blunt fin',
    unit: 'kg/m³',
  });
  const made = readPng(shot);
  assert.deepEqual([made.width, made.height], [3000, 2000]);
  for (const [x, y] of [
    [0, 0],
    [2999, 0],
    [2999, 1999],
    [1500, 1999],
  ])
    assert.equal(made.alphaAt(x, y), 0, `the ground at ${x}, ${y}`);
  const [left, right, top, bottom] = meshBounds(made);
  const said = [left, right, top, bottom].map((share) => share.toFixed(3)).join(', ');
  assert.ok(Math.abs((left + right) / 2 - 0.5) < 0.02, said);
  assert.ok(Math.abs((top + bottom) / 2 - 0.46) < 0.03, said);
  assert.ok(right - left > 0.7 || bottom - top > 0.6, said);
  // 380 units of the legend's 3.125 pixels, in the middle
  assert.ok(hasBelow(made, 1500 - 580, [68, 1, 84]), 'the first colour of the legend');
  assert.ok(hasBelow(made, 1500 + 580, [253, 231, 37]), 'the last colour of the legend');
  assert.deepEqual(await cameraOf(viewer), before);
  assert.deepEqual(viewer.problems, []);
  // A mesh that was turned, and is small on the screen, is as large in its picture.
  await viewer.page.evaluate(() => {
    const {cameraState} = window.qtetViewer;
    const [x, y, z, ...target] = cameraState;
    window.qtetViewer.cameraState = [1.4 * y, 1.4 * -x, 1.4 * z, ...target];
  });
  await viewer.settle();
  const turned = meshBounds(
    readPng(await picture(viewer, 'picture-turned', {width: 1280, height: 800})),
  );
  assert.ok(turned[1] - turned[0] > 0.7 || turned[3] - turned[2] > 0.6, `turned: ${turned}`);
  return `the mesh's bounds: ${said}; ${(shot.length / 1e6).toFixed(1)} MB`;
}

/** Camera, field and all else come back, in another mesh's page as well. */
async function opensTheViewOfADroppedPicture(context) {
  const query = 'mesh=fin&field=Velocity[0]&colormap=turbo&clip=x:0.4&projection=parallel';
  const viewer = await opened(context, query);
  await viewer.page.locator('qtet-viewer canvas.scene').focus();
  for (const key of ['ArrowLeft', 'ArrowUp', '+']) await viewer.page.keyboard.press(key);
  await viewer.settle();
  const camera = await cameraOf(viewer);
  const file = await picture(viewer, 'picture-view', {width: 600, height: 400});
  const names = ['mesh', 'field', 'colormap', 'clip', 'projection', 'edges'];
  const restored = async (its) => {
    assert.ok(await drop(its, file));
    await its.page.waitForFunction(() => window.qtetViewer.getAttribute('mesh') === 'fin');
    await its.waitForState('complete');
    await its.settle();
    const wanted = ['fin', 'Velocity[0]', 'turbo', 'x:0.4', 'parallel', null];
    assert.deepEqual(await attributes(its, ...names), wanted);
    (await cameraOf(its)).forEach((value, i) =>
      assert.ok(Math.abs(value - camera[i]) < 2e-3, `camera ${i}: ${value}, not ${camera[i]}`),
    );
    assert.deepEqual(its.problems, []);
  };
  await viewer.page.keyboard.press('ArrowRight');
  await viewer.page.getByRole('radio', {name: 'Viridis'}).check({force: true});
  await viewer.settle();
  await restored(viewer);
  const other = await opened(context, 'mesh=box&edges=off');
  await restored(other);
  await other.screenshot('picture-opened');
  assert.match(other.page.url(), /mesh=fin.*camera=/);

  const alert = other.page.getByRole('alert');
  await drop(other, await other.page.screenshot());
  await alert.waitFor();
  assert.match(await alert.innerText(), /The picture holds no view/);
  await drop(other, file.subarray(0, 60));
  await other.settle();
  assert.match(await alert.innerText(), /cut off/);
  await drop(other, file);
  await alert.waitFor({state: 'hidden'});
}

/** By keyboard alone, and without a size that no browser makes. */
async function takesPicturesByKeyboard(context) {
  for (const colorScheme of ['light', 'dark']) {
    const viewer = await opened(context, 'mesh=box&volume=auto', {
      ...kSmallDesktop,
      colorScheme,
    });
    const {page} = viewer;
    const button = page.getByRole('button', {name: 'Save picture'});
    await button.focus();
    await page.keyboard.press('Enter');
    const dialog = page.getByRole('dialog', {name: 'Save picture'});
    await dialog.waitFor();
    assert.deepEqual(await viewer.accessibilityViolations(), []);
    await viewer.screenshot(`picture-dialog-${colorScheme}`);
    const status = dialog.getByRole('status');
    await dialog.getByRole('combobox', {name: 'Size'}).selectOption('8K, 7680 × 4320');
    await dialog.getByRole('textbox', {name: 'Height'}).fill('4321');
    await page.keyboard.press('Enter');
    assert.match(await status.innerText(), /at most 7680 × 4320/);
    await page.keyboard.press('Escape');
    await dialog.waitFor({state: 'hidden'});
    assert.ok(await button.evaluate((its) => its.getRootNode().activeElement === its));

    await page.evaluate(() =>
      Object.defineProperty(navigator, 'clipboard', {
        value: {
          write: async ([item]) => {
            const copied = await item.getType('image/png');
            window.qtetCopied = [...new Uint8Array(await copied.arrayBuffer())];
          },
        },
      }),
    );
    await page.locator('qtet-viewer canvas.scene').focus();
    await page.keyboard.press('p');
    await dialog.waitFor();
    await dialog.getByRole('textbox', {name: 'Width'}).fill('300');
    await dialog.getByRole('textbox', {name: 'Height'}).fill('200');
    await dialog.getByRole('radio', {name: 'As seen'}).check({force: true});
    await dialog.getByRole('button', {name: 'Copy'}).click();
    await status.filter({hasText: 'Copied'}).waitFor();
    const copied = Buffer.from(await page.evaluate(() => window.qtetCopied));
    writeFileSync(join(viewer.out, `picture-volume-${colorScheme}.png`), copied);
    const made = readPng(copied);
    assert.deepEqual([made.width, made.height, made.alphaAt(150, 100)], [300, 200, 255]);
    assert.ok(coloredShare(made) > 0.05, `${coloredShare(made)} of the volume is coloured`);
    assert.deepEqual(viewer.problems, []);
    await context.browser.closePages();
  }
  const phone = await opened(context, 'mesh=fin', kCoarsePhone);
  await phone.page.getByRole('button', {name: 'Controls'}).tap();
  await phone.page.getByRole('button', {name: 'Save picture'}).tap();
  await phone.page.getByRole('dialog', {name: 'Save picture'}).waitFor();
  await phone.screenshot('picture-dialog-phone');
}

export const pictureChecks = {
  makesAPictureToPublish,
  opensTheViewOfADroppedPicture,
  takesPicturesByKeyboard,
};
