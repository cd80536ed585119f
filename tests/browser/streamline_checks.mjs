// Streamlines: the picture, the section and the address follow each other.

import assert from 'node:assert/strict';
import {turningBox} from './arrow_checks.mjs';
import {kSmallDesktop} from './browser.mjs';
import {serveMesh} from './programs.mjs';

const state = (viewer) => viewer.page.locator('qtet-viewer .flow-state');

async function streamlinesFollowTheSection(context) {
  const {server, browser} = context;
  await serveMesh(context, 'turning', turningBox());
  const viewer = await browser.openComplete(
    `${server.url}?mesh=turning&clip=none&opacity=0.2`,
    kSmallDesktop,
  );
  const {page} = viewer;
  const attribute = (name) => page.evaluate((its) => window.qtetViewer.getAttribute(its), name);
  await page.locator('qtet-viewer summary', {hasText: /^Streamlines$/}).click();
  const seeds = page.locator('qtet-viewer select[name=seeds]');
  const count = page.locator('qtet-viewer input[name=seeds-count]');
  const body = page.locator('qtet-viewer .streamlines-body');
  assert.equal(await body.isVisible(), false, 'without lines there is only the switch');
  await page.getByRole('switch', {name: 'Streamlines'}).click();
  await state(viewer)
    .filter({hasText: /^100 lines, along U within/})
    .waitFor();
  assert.equal(await attribute('streamlines'), 'U');
  await seeds.selectOption('plane');
  await state(viewer)
    .filter({hasText: /^\d\d lines/})
    .waitFor();
  assert.match(await attribute('seeds'), /^plane z:0.5 10$/, 'across the longest side');
  await count.fill('0');
  await count.press('Enter');
  assert.match(await attribute('seeds'), /10$/, 'a wrong number changes nothing');
  await seeds.selectOption('sphere');
  await state(viewer)
    .filter({hasText: /^50 lines/})
    .waitFor();
  await page.getByText('Dashes', {exact: true}).click();
  assert.equal(await attribute('streamline-look'), 'dashes');
  await page.getByRole('switch', {name: 'Line at the pointer'}).click();
  const canvas = await page.locator('qtet-viewer .scene').boundingBox();
  const middle = [canvas.x + canvas.width * 0.36, canvas.y + canvas.height * 0.5];
  await page.mouse.move(...middle);
  await page.locator('qtet-viewer path.flow').waitFor({state: 'attached'});
  await page.mouse.click(...middle);
  await state(viewer)
    .filter({hasText: /^51 lines/})
    .waitFor();
  assert.match(await attribute('seeds'), /^sphere .*; line .* 1$/, 'a click keeps the line');
  await page.keyboard.press('Control+z');
  await state(viewer)
    .filter({hasText: /^50 lines/})
    .waitFor();
  await page.getByRole('switch', {name: 'Streamlines'}).click();
  await body.waitFor({state: 'hidden'});
  assert.equal(await page.locator('qtet-viewer path.flow').count(), 0);
  await browser.closePages();
}

async function streamlinesThatDoNotFitAreNamed({server, browser}) {
  const viewer = await browser.openComplete(
    `${server.url}?mesh=turning&streamlines=x&seeds=ring+3`,
    kSmallDesktop,
  );
  const notice = viewer.page.locator('qtet-viewer .notice');
  await notice.filter({hasText: 'seeds="ring 3" is not understood'}).waitFor();
  await notice
    .filter({hasText: 'streamlines="x" is not shown: it takes a field of points'})
    .waitFor();
  await browser.closePages();
}

export const streamlineChecks = {streamlinesFollowTheSection, streamlinesThatDoNotFitAreNamed};
