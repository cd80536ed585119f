// The box with numbers round the mesh: behind it, on the screen and in saved pictures.

import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {kCoarsePhone, kDesktop} from './browser.mjs';
import {readPng} from './png.mjs';

const opened = ({server, browser}, query, device) =>
  browser.openComplete(`${server.url}?${query}`, device);

/** The texts with their rectangles, and those of the cards. */
const rulerOf = (viewer) =>
  viewer.page.evaluate(() => {
    const {shadowRoot} = window.qtetViewer;
    const rectangle = (its) => {
      const {left, right, top, bottom} = its.getBoundingClientRect();
      return {left, right, top, bottom, text: its.textContent};
    };
    return {
      isShown: !(shadowRoot.querySelector('.ruler')?.hasAttribute('hidden') ?? true),
      texts: [...shadowRoot.querySelectorAll('.ruler text')].map(rectangle),
      cards: ['.panel', '.legend'].map((name) => rectangle(shadowRoot.querySelector(name))),
      viewer: rectangle(window.qtetViewer),
      path: shadowRoot.querySelector('.ruler .box')?.getAttribute('d') ?? '',
    };
  });

const waitForRuler = (viewer, isShown = true) =>
  viewer.page.waitForFunction(
    (wanted) => {
      const ruler = window.qtetViewer.shadowRoot.querySelector('.ruler');
      return ruler !== null && ruler.hasAttribute('hidden') !== wanted;
    },
    isShown,
    {polling: 50},
  );

const overlap = (a, b) =>
  a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

/** Numbers and names lie inside the viewer, beside each other and beside the cards. */
async function keepsItsNumbersLegible(context) {
  for (const colorScheme of ['light', 'dark'])
    for (const [name, device] of Object.entries({desktop: kDesktop, phone: kCoarsePhone})) {
      const viewer = await opened(context, 'mesh=fin&axes=on&length-unit=mm', {
        ...device,
        colorScheme,
      });
      await waitForRuler(viewer);
      await viewer.settle();
      await viewer.screenshot(`axes-${name}-${colorScheme}`);
      const {texts, cards, viewer: whole} = await rulerOf(viewer);
      const named = texts.map(({text}) => text);
      for (const axis of ['x [mm]', 'y [mm]', 'z [mm]'])
        assert.ok(named.includes(axis), `${named}`);
      assert.ok(named.length >= 8, `${named}`);
      texts.forEach((text, i) => {
        const said = JSON.stringify(text);
        assert.ok(text.left >= 0 && text.right <= whole.right, `${name}: outside: ${said}`);
        for (const other of [...cards, ...texts.slice(i + 1)])
          assert.ok(!overlap(text, other), `${name}: ${said} and ${JSON.stringify(other)}`);
      });
      assert.deepEqual(await viewer.accessibilityViolations(), []);
      assert.deepEqual(viewer.problems, []);
      await context.browser.closePages();
    }
}

/** It comes by key, is undone, follows the camera, and is part of the address. */
async function switchesAndFollows(context) {
  const requests = [];
  const viewer = await opened(context, 'mesh=box');
  const {page} = viewer;
  page.on('request', (request) => requests.push(request.url()));
  const isLoaded = () => requests.some((url) => /\/ruler-[^/]*\.js$/.test(url));
  const axes = () => page.evaluate(() => window.qtetViewer.getAttribute('axes'));
  await page.locator('qtet-viewer .scene').focus();
  assert.equal(isLoaded(), false);
  await page.keyboard.press('a');
  await waitForRuler(viewer);
  assert.ok(isLoaded(), 'it is loaded when it is wanted');
  await page.waitForURL(/axes=on/);
  await viewer.settle();
  const before = await rulerOf(viewer);
  await page.keyboard.press('ArrowRight');
  await viewer.settle();
  assert.notEqual((await rulerOf(viewer)).path, before.path);
  await page.keyboard.press('Home');
  await viewer.settle();
  await page.keyboard.press('Control+z'); // the turn
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await waitForRuler(viewer, false);
  assert.equal(await axes(), null);
  await page.locator('qtet-viewer summary', {hasText: 'View'}).click();
  await page.getByRole('switch', {name: 'Axes with numbers'}).click();
  await waitForRuler(viewer);
  assert.equal(await axes(), 'on');
  assert.deepEqual(viewer.problems, []);
}

/** A saved picture has the box behind the mesh, with the mesh's place between the numbers. */
async function standsInSavedPictures(context) {
  const dark = {};
  for (const axes of ['on', 'off']) {
    const viewer = await opened(context, `mesh=fin&clip=none&axes=${axes}`);
    if (axes === 'on') await waitForRuler(viewer);
    const {page} = viewer;
    await page.getByRole('button', {name: 'Save picture'}).click();
    const dialog = page.getByRole('dialog', {name: 'Save picture'});
    await dialog.getByRole('textbox', {name: 'Width'}).fill('1200');
    await dialog.getByRole('textbox', {name: 'Height'}).fill('800');
    const saved = page.waitForEvent('download');
    await dialog.getByRole('button', {name: 'Save', exact: true}).click();
    const {width, height, at} = readPng(await readDownload(await saved, viewer, axes));
    const rows = Array.from({length: Math.round(0.7 * height)}, (_, i) => i + 0.1 * height);
    const isColoured = (x, y) => Math.max(...at(x, y)) - Math.min(...at(x, y)) > 60;
    let left = 0;
    while (left < width && !rows.some((y) => isColoured(left, Math.round(y)))) ++left;
    let count = 0;
    for (const y of rows)
      for (let x = 0; x < left - 2; ++x) count += Math.max(...at(x, Math.round(y))) < 200 ? 1 : 0;
    dark[axes] = count;
    assert.deepEqual(viewer.problems, []);
    await context.browser.closePages();
  }
  assert.equal(dark.off, 0);
  assert.ok(dark.on > 100, `${dark.on} dark pixels to the left of the mesh`);
}

async function readDownload(download, viewer, axes) {
  const file = readFileSync(await download.path());
  writeFileSync(join(viewer.out, `axes-picture-${axes}.png`), file);
  return file;
}

export const axesChecks = {
  axesKeepTheirNumbersLegible: keepsItsNumbersLegible,
  axesSwitchAndFollow: switchesAndFollows,
  axesStandInSavedPictures: standsInSavedPictures,
};
