// The panel and what lies in the picture's corners: found at once, folded, reached by keyboard.

import assert from 'node:assert/strict';
import {kCoarsePhone, kDesktop} from './browser.mjs';
import {differingShare} from './png.mjs';
import {PoorLine} from './poor_line.mjs';

const opened = ({server, browser}, query, device, before) =>
  browser.openComplete(`${server.url}?${query}`, device, before);

const kActions = ['Reset view', 'Save picture', 'Share', 'Full screen', 'Keys'];

/** Actions are found without scrolling, with a name and a tooltip, also by keyboard. */
async function showsItsActionsAtOnce(context) {
  for (const colorScheme of ['light', 'dark']) {
    const viewer = await opened(context, 'mesh=fin', {...kDesktop, colorScheme});
    const {page} = viewer;
    await viewer.screenshot(`panel-${colorScheme}`);
    const panel = await page.locator('qtet-viewer .panel').boundingBox();
    for (const name of kActions) {
      const button = page.getByRole('button', {name, exact: true});
      const {y, height} = await button.boundingBox();
      assert.ok(y + height < panel.y + 120, `${name} lies at ${y}, the panel begins at ${panel.y}`);
      assert.ok((await button.getAttribute('title')).startsWith(name));
    }
    assert.deepEqual(await viewer.accessibilityViolations(), []);
    await context.browser.closePages();
  }
  const viewer = await opened(context, 'mesh=fin');
  const {page} = viewer;
  await page.getByRole('button', {name: 'Controls'}).focus();
  await page.keyboard.press('Tab');
  await page.keyboard.press('Tab');
  await page.keyboard.press('Enter'); // the second of the row
  await page.getByRole('dialog', {name: 'Save picture'}).waitFor();
  const [saved] = await Promise.all([
    page.waitForEvent('download'),
    page.keyboard.press('Enter'), // the button that has the focus
  ]);
  assert.match(saved.suggestedFilename(), /^fin_\w+(-\w+)?(_clip-[xyz]-0.5)?\.png$/);
}

const openFolds = (viewer) =>
  viewer.page.evaluate(() =>
    [...window.qtetViewer.shadowRoot.querySelectorAll('details')]
      .filter(({open, hidden}) => open && !hidden)
      .map((its) => its.dataset.fold),
  );

/** Every section folds, and is as it was left when the page is loaded again. */
async function remembersItsFolds(context) {
  const viewer = await opened(context, 'mesh=box');
  assert.deepEqual(await openFolds(viewer), ['colours', 'surface', 'inside', 'pointer']);
  for (const section of ['Surface', 'Pointer', 'View'])
    await viewer.page.locator('qtet-viewer summary', {hasText: section}).click();
  // They are kept in an event's task after the click.
  await viewer.page.waitForFunction(() => localStorage['qtet-viewer-folds'].includes('view'));
  await viewer.page.reload();
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  assert.deepEqual(await openFolds(viewer), ['colours', 'inside', 'view']);
  await viewer.screenshot('panel-folds');
  const forgetful = await opened(context, 'mesh=box', kDesktop, () =>
    Object.defineProperty(window, 'localStorage', {
      get() {
        throw new Error('forbidden');
      },
    }),
  );
  await forgetful.page.locator('qtet-viewer summary', {hasText: 'View'}).click();
  await forgetful.settle();
  assert.deepEqual(await openFolds(forgetful), ['colours', 'surface', 'inside', 'pointer', 'view']);
  assert.deepEqual(forgetful.problems, []);
}

/** The share of the viewer that neither the panel nor the legend covers. */
const freeShare = (viewer) =>
  viewer.page.evaluate(() => {
    const {shadowRoot, clientWidth, clientHeight} = window.qtetViewer;
    const covered = ['.panel', '.legend'].map((name) => {
      const {width, height} = shadowRoot.querySelector(name).getBoundingClientRect();
      return width * height;
    });
    return 1 - (covered[0] + covered[1]) / (clientWidth * clientHeight);
  });

/** In a low window half of the area is the mesh's, with the sheet pulled up as well. */
async function keepsHalfOfALowWindow(context) {
  const viewer = await opened(context, 'mesh=fin', {viewport: {width: 640, height: 400}});
  await viewer.settle();
  const folded = await freeShare(viewer);
  await viewer.screenshot('panel-low');
  await viewer.page.getByRole('button', {name: 'Controls'}).click();
  await viewer.settle();
  const pulled = await freeShare(viewer);
  await viewer.screenshot('panel-low-pulled');
  assert.ok(folded >= 0.5 && pulled >= 0.5, `free: ${folded} folded, ${pulled} pulled up`);
  const phone = await opened(context, 'mesh=fin', kCoarsePhone);
  await phone.page.getByRole('button', {name: 'Controls'}).tap();
  await phone.settle();
  await phone.screenshot('panel-phone');
  return `free: ${folded.toFixed(2)} folded, ${pulled.toFixed(2)} pulled up`;
}

/** Where the corners of the mesh's bounds lie: [left, top, right, bottom] in CSS pixels. */
const boxOnCanvas = (viewer) =>
  viewer.page.evaluate(() => {
    const {meshView, viewing} = window.qtetViewer;
    const {bounds} = viewing.mesh.snapshot;
    const places = Array.from({length: 8}, (_, i) =>
      meshView.project([0, 1, 2].map((axis) => bounds[axis + (i & (1 << axis) ? 3 : 0)])),
    );
    const [x, y] = ['x', 'y'].map((its) => places.map((place) => place[its]));
    return [Math.min(...x), Math.min(...y), Math.max(...x), Math.max(...y)];
  });

/** The viewer's picture and a frame of another size, as addresses of PNG files. */
const savedPictures = (viewer) =>
  viewer.page.evaluate(async () => {
    const {meshView} = window.qtetViewer;
    const insets = {left: 0, right: 0, top: 0, bottom: 0};
    const {
      tiles: [{bitmap}],
    } = await meshView.render({width: 600, height: 400, insets, pixelRatio: 1});
    const canvas = new OffscreenCanvas(600, 400);
    canvas.getContext('2d').drawImage(bitmap, 0, 0);
    const files = [await window.qtetViewer.picture(), await canvas.convertToBlob()];
    const bytes = await Promise.all(files.map((file) => file.arrayBuffer()));
    return bytes.map((its) => [...new Uint8Array(its)].join());
  });

/** An open sheet lets the mesh go above it. Camera and saved pictures stay. */
async function liftsTheMeshAboveAnOpenSheet(context) {
  const notes = [];
  for (const query of ['mesh=box&clip=none', 'mesh=box&clip=y:0.5&camera=1,-4.6,2,0,0,0']) {
    const viewer = await opened(context, query, kCoarsePhone);
    const {page} = viewer;
    await viewer.settle();
    const before = await boxOnCanvas(viewer);
    const [camera, pictures] = [await cameraOf(viewer), await savedPictures(viewer)];
    const fold = page.getByRole('button', {name: 'Controls'});
    await fold.tap();
    await viewer.settle();
    await viewer.screenshot(`panel-lifted-${notes.length}`);
    const [left, top, right, bottom] = await boxOnCanvas(viewer);
    const [sheet, legend] = await Promise.all(
      ['.panel', '.legend'].map((its) => page.locator(`qtet-viewer ${its}`).boundingBox()),
    );
    const place = `${[left, top, right, bottom].map(Math.round)}`;
    assert.ok(left >= 0 && right <= 390, place);
    assert.ok(top >= legend.y + legend.height && bottom <= sheet.y, place);
    const middle = [(left + right) / 2, (top + bottom) / 2];
    assert.ok(Math.abs(2 * middle[1] - legend.y - legend.height - sheet.y) < 40, place);
    assert.deepEqual(await cameraOf(viewer), camera);
    assert.deepEqual(await savedPictures(viewer), pictures);
    await viewer.settle();
    const picked = await page.evaluate(async ([x, y]) => {
      const {client, meshView} = window.qtetViewer;
      const {lattice} = await client.pick(meshView.rayAt(x, y));
      return meshView.project(lattice);
    }, middle);
    assert.ok(Math.hypot(picked.x - middle[0], picked.y - middle[1]) < 1, JSON.stringify(picked));
    await fold.tap();
    await viewer.settle();
    assert.deepEqual(await boxOnCanvas(viewer), before);
    notes.push(`${before.map(Math.round)} to ${place}`);
    assert.deepEqual(viewer.problems, []);
    await context.browser.closePages();
  }
  return notes.join('; ');
}

const cameraOf = (viewer) => viewer.page.evaluate(() => window.qtetViewer.cameraState);

/** A face of the cube looks along its axis, by a click and by the keyboard. */
async function turnsByTheCube(context) {
  for (const colorScheme of ['light', 'dark']) {
    const viewer = await opened(context, 'mesh=box', {...kDesktop, colorScheme});
    const {page} = viewer;
    await page.getByRole('button', {name: 'View from +x'}).waitFor();
    await viewer.screenshot(`cube-${colorScheme}`);
    assert.deepEqual(await viewer.accessibilityViolations(), []);
    const face = await page.getByRole('button', {name: 'View from +z'}).boundingBox();
    await page.mouse.click(face.x + face.width / 2, face.y + face.height / 2);
    await viewer.settle();
    const [x, y, z, ...target] = await cameraOf(viewer);
    assert.ok(z > 1 && Math.hypot(x, y) < 0.01 * z, `from ${[x, y, z]} to ${target}`);
    await page.getByRole('button', {name: 'View from +x'}).focus();
    await page.keyboard.press('ArrowRight');
    await viewer.screenshot(`cube-focus-${colorScheme}`);
    await page.keyboard.press('Enter');
    await viewer.settle();
    const from = await cameraOf(viewer);
    assert.ok(from[0] < -1 && Math.hypot(from[1], from[2]) < 0.01 * -from[0], `from ${from}`);
    assert.deepEqual(viewer.problems, []);
    await context.browser.closePages();
  }
}

/** On phones the whole cube is one target; a tap looks along the nearest face. */
async function turnsByATapOnTheCube(context) {
  const viewer = await opened(context, 'mesh=box', kCoarsePhone);
  const {page} = viewer;
  await page.getByRole('button', {name: 'View from +z'}).waitFor();
  const {x, y, width, height} = await page.locator('qtet-viewer .orientation-cube').boundingBox();
  assert.ok(width >= 44 && height >= 44, `${width} x ${height}`);
  await page.touchscreen.tap(x + width / 2, y + 5); // above the cube
  await viewer.settle();
  const [from, side, above] = await cameraOf(viewer);
  assert.ok(above > 1 && Math.hypot(from, side) < 0.01 * above, `from ${[from, side, above]}`);
}

/** A pointer that rests shows the value below it, and nothing moves. */
async function showsTheValueAtThePointer(context) {
  const viewer = await opened(context, 'mesh=fin&field=Density&clip=none');
  const {page} = viewer;
  const label = page.locator('qtet-viewer .hover');
  const content = 'qtet-viewer::part(hint), qtet-viewer::part(marks) { display: none }';
  const hide = () => page.addStyleTag({content});
  const before = await viewer.screenshot('hover-before');
  const camera = await cameraOf(viewer);
  await page.mouse.move(500, 340);
  await label.waitFor();
  assert.match(await label.innerText(), /^Density [\d.]+$/);
  await viewer.screenshot('hover');
  assert.equal(await page.locator('qtet-viewer .result').isVisible(), false);
  await page.mouse.move(40, 600, {steps: 2}); // beside the mesh
  await viewer.settle();
  assert.equal(await label.isVisible(), false);
  await page.mouse.move(500, 340);
  await label.waitFor();
  const style = await hide();
  assert.equal(differingShare(before, await viewer.screenshot('hover-bare')), 0);
  assert.deepEqual(await cameraOf(viewer), camera);
  await style.evaluate((its) => its.remove());
  await page.mouse.down();
  assert.equal(await label.isVisible(), false);
  await page.mouse.up();
  const phone = await opened(context, 'mesh=fin&clip=none', kCoarsePhone);
  await phone.page.touchscreen.tap(195, 350);
  await phone.settle();
  assert.equal(await phone.page.locator('qtet-viewer .hover').isVisible(), false);
  await phone.screenshot('cube-phone');
}

/** A page that runs from right to left changes nothing within the viewer. */
async function staysAsItIsInAPageFromRightToLeft(context) {
  for (const [name, device] of Object.entries({desktop: kDesktop, phone: kCoarsePhone})) {
    const pictures = [];
    for (const dir of ['ltr', 'rtl']) {
      const viewer = await opened(context, 'mesh=box&clip=none', device);
      const {page} = viewer;
      await page.getByRole('button', {name: 'View from +x'}).waitFor();
      await page.evaluate((its) => (document.documentElement.dir = its), dir);
      if (device.isMobile) await page.getByRole('button', {name: 'Controls'}).tap();
      await page.locator('qtet-viewer .histogram .end').first().waitFor();
      await viewer.settle();
      pictures.push(await viewer.screenshot(`panel-${dir}-${name}`));
      assert.deepEqual(viewer.problems, []);
      await context.browser.closePages({areSound: false});
    }
    assert.equal(differingShare(...pictures), 0, name);
  }
}

/** A slip in a link is answered by the word that was probably meant. */
async function namesTheNearestWord(context) {
  const viewer = await opened(context, 'mesh=box&colourmap=turbo&utm_source=mail');
  const alert = viewer.page.getByRole('alert');
  assert.match(await alert.innerText(), /"colourmap", which .* Did you mean "colormap"\?/);
  assert.doesNotMatch(await alert.innerText(), /utm/);
  await viewer.screenshot('panel-slip');
  const other = await opened(context, 'mesh=fin&field=Presure&colormap=viridsi');
  const said = await other.page.getByRole('alert').innerText();
  assert.match(said, /no field "Presure"\. Did you mean "Pressure"\?/);
  assert.match(said, /Did you mean "viridis"\?/);
  const beyond = await opened(context, 'mesh=fin&field=Velocity[3]');
  assert.match(
    await beyond.page.getByRole('alert').innerText(),
    /field="Velocity\[3\]".* It has Velocity\[0\] to Velocity\[2\]\. Its magnitude is shown\./,
  );
  const menu = beyond.page.locator('qtet-viewer select[name=field]');
  assert.equal(await menu.inputValue(), 'Velocity');
  await beyond.screenshot('panel-component');
}

/** Nothing "stays on the screen" if the damage came before the first picture. */
async function promisesNothingOfADamagedHead({server, browser}) {
  const notes = [];
  for (const damageAt of [400, 1200, 4000]) {
    const line = await PoorLine.open(server.port, {streamsOnly: true, damageAt});
    try {
      const viewer = await browser.open(`${line.url}?mesh=fin`);
      await viewer.waitForState('failed');
      const said = await viewer.page.getByRole('alert').innerText();
      assert.doesNotMatch(said, /stays/, `byte ${damageAt}`);
      notes.push(`byte ${damageAt}: ${said.split('\n')[0]}`);
    } finally {
      line.close();
    }
  }
  return notes.join('; ');
}

export const panelChecks = {
  showsItsActionsAtOnce,
  remembersItsFolds,
  keepsHalfOfALowWindow,
  liftsTheMeshAboveAnOpenSheet,
  turnsByTheCube,
  turnsByATapOnTheCube,
  showsTheValueAtThePointer,
  staysAsItIsInAPageFromRightToLeft,
  namesTheNearestWord,
  promisesNothingOfADamagedHead,
};
