// Fields that are computed from others, in the menu, the address and beside a series.

import assert from 'node:assert/strict';
import {kSmallDesktop} from './browser.mjs';

/** Longer than changes that are one step lie apart. */
const kStepMs = 400;

async function showsOwnFields({server, browser}) {
  const viewer = await browser.openComplete(`${server.url}?mesh=box`, kSmallDesktop);
  await viewer.waitForControls();
  const {page} = viewer;
  const names = await page.locator('qtet-viewer select[name=field] option').allInnerTexts();
  await page.locator('qtet-viewer summary', {hasText: 'Own fields'}).click();
  const lines = page.getByLabel('Definition of an own field');
  await lines.first().fill(`twice = 2 * \`${names[0]}\` + 1`);
  await lines.first().press('Enter');
  await page.waitForFunction(() => window.qtetViewer.getAttribute('field') === 'twice');
  await viewer.settle();
  assert.equal(await viewer.text('.legend-name'), 'twice');
  const {searchParams} = new URL(page.url());
  assert.equal(searchParams.get('derived'), `twice = 2 * \`${names[0]}\` + 1`);
  await lines.nth(1).fill('wrong = twice +');
  await lines.nth(1).press('Enter');
  await page.getByText('column 16: the text ends').waitFor();
  await lines.nth(1).fill('');
  await lines.nth(1).press('Enter');
  await lines.first().fill(`thrice = 3 * \`${names[0]}\``);
  await lines.first().press('Enter');
  const shown = () =>
    page.evaluate(() => ['derived', 'field'].map((name) => window.qtetViewer.getAttribute(name)));
  await viewer.settle();
  assert.deepEqual(await shown(), [`thrice = 3 * \`${names[0]}\``, null]);
  assert.equal(await viewer.text('.legend-name'), names[0]);
  assert.equal(await page.locator('qtet-viewer .notice .message').count(), 0);
  await page.waitForTimeout(kStepMs);
  await page.locator('qtet-viewer .scene').focus();
  await page.keyboard.press('Control+z');
  await viewer.settle();
  assert.deepEqual(await shown(), [`twice = 2 * \`${names[0]}\` + 1`, 'twice']);
  assert.equal(await viewer.text('.legend-name'), 'twice');

  const again = await browser.openComplete(
    `${server.url}?mesh=box&derived=a=mag(-\`${names[0]}\`);b=a>1e9?1:a&field=b&iso=a=0.5`,
    kSmallDesktop,
  );
  await again.waitForPicture();
  await again.settle();
  assert.equal(await again.text('.legend-name'), 'b');
  const soup = await again.page.evaluate(() => window.qtetViewer.getAttribute('iso'));
  assert.equal(soup, 'a=0.5');
  assert.equal(await again.page.locator('qtet-viewer .notice .message').count(), 0);
  return `beside ${names.length} fields: one that is typed, one that is wrong, two of an address`;
}

export const derivedChecks = {showsOwnFields};
