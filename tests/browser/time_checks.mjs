// The bar of a series: as wide as the picture, by pointer, keys and typed times.

import assert from 'node:assert/strict';
import {kDesktop, kPhone} from './browser.mjs';
import {makeLog} from './programs.mjs';

/** The pixels by which the slider is narrower than the picture above it, at each side. */
const kMaxMargin = 40;

/** The left, right and bottom of the picture that is free, and of the slider. */
const placesOf = ({page}) =>
  page.evaluate(() => {
    const {shadowRoot: root} = window.qtetViewer;
    const box = (name) => root.querySelector(name).getBoundingClientRect();
    const [panel, slider, legend] = ['.panel', '.time input', '.legend'].map(box);
    const isSheet = panel.left === 0;
    return {
      right: (isSheet ? innerWidth : panel.left) - slider.right,
      left: slider.left,
      below: (isSheet ? panel.top : innerHeight) - slider.bottom,
      overlap: !isSheet && legend.bottom > slider.top,
    };
  });

async function theTimeIsAsWideAsThePicture({server, browser, out, bin}) {
  const options = ['--fields', 'Density', '--unit', 'Density=kg/m3', '--time-unit', 's'];
  makeLog(bin, 'part', out, ['fin', '--steps', '5', '--cells', '5000'], options);
  server.kill();
  await server.start();
  const address = `${server.url}?mesh=part&time-range=1,3&time-loop=off`;
  for (const [name, device] of [
    ['desktop', kDesktop],
    ['desktop-dark', {...kDesktop, colorScheme: 'dark'}],
    ['phone', kPhone],
    ['phone-dark', {...kPhone, colorScheme: 'dark'}],
  ]) {
    const viewer = await browser.open(address, device);
    await viewer.waitForState('complete');
    await viewer.page.getByRole('button', {name: 'First instant'}).waitFor();
    await viewer.settle();
    const {left, right, below, overlap} = await placesOf(viewer);
    assert.ok(left < kMaxMargin && right < kMaxMargin && below > 0 && !overlap, name);
    assert.deepEqual(await viewer.accessibilityViolations(), []);
    await viewer.screenshot(`time-${name}`);
  }

  const viewer = await browser.open(address);
  await viewer.waitForState('complete');
  const {page} = viewer;
  const typed = page.getByRole('textbox', {name: 'Go to the time'});
  await typed.fill('3.7');
  await typed.press('Enter');
  const attribute = (name) => page.evaluate((its) => window.qtetViewer.getAttribute(its), name);
  assert.deepEqual([await typed.inputValue(), await attribute('time')], ['4', '4']);
  // It is outside the part, so that playing begins with the part's first instant.
  const button = (name) => page.getByRole('button', {name, exact: true});
  await button('Play').press('Enter');
  await page.waitForFunction(
    () => !window.qtetViewer.playing && window.qtetViewer.getAttribute('time') === '3',
  );
  await page.locator('qtet-viewer canvas.scene').focus();
  await page.keyboard.press('<');
  assert.equal(await typed.inputValue(), '0');
  await button('Play from here').press('Enter');
  assert.equal(await attribute('time-range'), '0,3');
  await button('Begin again at the end').press('Enter');
  assert.equal(await attribute('time-loop'), null);
  await viewer.settle();
  await page.keyboard.press('Control+z');
  assert.deepEqual([await attribute('time-loop'), await attribute('time-range')], ['off', '0,3']);
  await page.keyboard.press('Control+z');
  assert.equal(await attribute('time-range'), '1,3');
  assert.deepEqual(viewer.problems, []);
}

/** In the legend, a point's card, and a plot's readout. */
async function unitsStandWhereValuesAre({server, browser, out, bin}) {
  const options = ['--unit', 'Density=kg/m3', '--unit', 'Velocity=m/s', '--time-unit', 's'];
  makeLog(bin, 'units', out, ['fin', '--steps', '4', '--cells', '5000'], options);
  server.kill();
  await server.start();
  for (const [name, device] of [
    ['desktop', kDesktop],
    ['phone-dark', {...kPhone, colorScheme: 'dark'}],
  ]) {
    const viewer = await browser.open(`${server.url}?mesh=units&field=Velocity`, device);
    await viewer.waitForState('complete');
    const {page} = viewer;
    await page.getByRole('button', {name: 'First instant'}).waitFor();
    await viewer.settle();
    assert.equal(await viewer.text('.legend-name'), 'Velocity, magnitude [m/s]');
    await page.locator('qtet-viewer canvas.scene').focus();
    await page.keyboard.press('i');
    const card = page.locator('qtet-viewer .result');
    await card.waitFor();
    const titles = await card.locator('dt').allInnerTexts();
    assert.ok(
      titles.some((title) => /^Velocity.*, magnitude \[m\/s\]$/.test(title)),
      titles.join(),
    );
    await page.getByRole('button', {name: 'Over time'}).click();
    await card.locator('canvas').waitFor();
    await viewer.settle();
    await viewer.screenshot(`units-${name}`);
    assert.deepEqual(viewer.problems, []);
  }
}

export const timeChecks = {theTimeIsAsWideAsThePicture, unitsStandWhereValuesAre};
