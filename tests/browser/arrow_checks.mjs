// Arrows: the picture, the section and the address follow each other.

import assert from 'node:assert/strict';
import {kSmallDesktop} from './browser.mjs';
import {serveMesh} from './programs.mjs';
import {linearBox} from './volume_checks.mjs';

/** The vectors of a box of 1 x 2 x 3 turn round its middle axis, and rise. */
export const turningBox = () => linearBox(6, {U: (x, y) => [1 - y, x - 0.5, 0.25]});

async function arrowsFollowTheSection(context) {
  const {server, browser} = context;
  await serveMesh(context, 'turning', turningBox());
  const viewer = await browser.openComplete(`${server.url}?mesh=turning&clip=none`, kSmallDesktop);
  const {page} = viewer;
  const attribute = (name) => page.evaluate((its) => window.qtetViewer.getAttribute(its), name);
  const state = page.locator('qtet-viewer .arrows-state');
  const count = async () => Number(/^[\d\s]+/.exec(await state.innerText())[0].replace(/\s/g, ''));
  await page.locator('qtet-viewer summary', {hasText: /^Arrows$/}).click();
  const plain = await viewer.screenshot('arrows-off');
  await page.getByRole('switch', {name: 'Arrows'}).click();
  await state.filter({hasText: /^\d.* arrows\.$/}).waitFor();
  await viewer.settle();
  assert.equal(await attribute('arrows'), 'U');
  assert.notDeepEqual(await viewer.screenshot('arrows-on'), plain, 'arrows are drawn');
  const onSurface = await count();
  const density = page.locator('qtet-viewer input[name=arrow-density]');
  await density.focus();
  await page.keyboard.press('End');
  await page.waitForFunction(() => window.qtetViewer.getAttribute('arrow-density') === '100');
  await page.waitForFunction(
    (before) => window.qtetViewer.viewing.mesh.snapshot.arrows.count > 4 * before,
    onSurface,
  );
  await page.keyboard.press('Control+z');
  await page.locator('qtet-viewer .arrows').getByText('Vertices').click();
  await state.filter({hasText: /^1.?729 arrows/}).waitFor();
  assert.equal(await attribute('arrow-places'), 'vertices');
  await page.getByRole('switch', {name: 'Arrows'}).click();
  await page.locator('qtet-viewer .arrows-body').waitFor({state: 'hidden'});
  await page.waitForFunction(() => window.qtetViewer.viewing.mesh.snapshot.arrows === null);
  await browser.closePages();
  return `${onSurface} on the surface`;
}

export const arrowChecks = {arrowsFollowTheSection};
