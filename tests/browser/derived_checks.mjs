// Fields that are computed from others, in the menu, the address and beside a series.

import assert from 'node:assert/strict';
import {kSmallDesktop} from './browser.mjs';
import {serveMesh} from './programs.mjs';
import {linearBox} from './volume_checks.mjs';

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

/** Gradients have the values of hand, at each place, whichever way they are asked for. */
async function showsGradients(context) {
  const {server, browser} = context;
  const U = (x, y, z) => [2 * z - 3 * y, 3 * x - z, y - 2 * x];
  const Height = (x, y, z) => 4 * z + x * 1.5;
  await serveMesh(
    context,
    'rotation',
    linearBox(6, {U, Height}, () => true),
  );
  const viewer = await browser.openSettled(
    `${server.url}?mesh=rotation&field=U.Q&points=0.3,0,1.1 0,1,2`,
    kSmallDesktop,
  );
  const {page} = viewer;
  const values = () =>
    page.evaluate(() =>
      [...window.qtetViewer.shadowRoot.querySelectorAll('.pin button:first-child')].map(
        ({textContent}) => Number(textContent.replace('\u2212', '-')),
      ),
    );
  const areNear = async (name, right) => {
    await page.evaluate((field) => window.qtetViewer.setAttribute('field', field), name);
    await viewer.settle();
    for (const value of await values())
      assert.ok(Math.abs(value - right) < 0.01 * (1 + Math.abs(right)), `${name}: ${value}`);
  };
  assert.equal(await viewer.text('.legend-name'), 'U, Q criterion');
  await areNear('U.Q', 14);
  await areNear('U.vorticity', 2 * Math.sqrt(14));
  await areNear('U.div', 0);
  const offered = await page.locator('qtet-viewer select[name=field] option').allInnerTexts();
  for (const title of ['U, divergence', 'U, vorticity', 'U, Q criterion'])
    assert.ok(offered.includes(title), `${title} is not in ${offered.join()}`);
  await page.locator('qtet-viewer summary', {hasText: 'Own fields'}).click();
  const line = page.getByLabel('Definition of an own field').first();
  await line.fill('steep = mag(grad(Height)) + curl(U).y');
  await line.press('Enter');
  await page.waitForFunction(() => window.qtetViewer.getAttribute('field') === 'steep');
  await areNear('steep', Math.hypot(4, 1.5) + 4);
  await viewer.screenshot('derived-gradient');
  assert.match(await viewer.text('.error-left'), /not known/);
  const second = page.getByLabel('Definition of an own field').nth(1);
  await second.fill('no = grad(which).x');
  await second.press('Enter');
  await page.getByText('"which" is of cells, and constant in each').waitFor();
  assert.deepEqual(viewer.problems, []);
}

export const derivedChecks = {showsOwnFields, showsGradients};
