// Numbers about what is drawn: right where answers are exact, and in line with the picture.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {kCoarsePhone, kDesktop} from './browser.mjs';
import {makeLog, serveMesh} from './programs.mjs';
import {linearBox} from './volume_checks.mjs';

/** Longer than the numbers follow the picture. */
const kRestMs = 1500;

/** The rows by title: the numbers of a row, and the text behind them. */
const rowsOf = (viewer) =>
  viewer.page.evaluate(() =>
    Object.fromEntries(
      [...window.qtetViewer.shadowRoot.querySelectorAll('.numbers > div')].map((row) => {
        const [title, value] = row.children;
        const text = value.firstChild.textContent.replaceAll('\u2212', '-');
        return [title.textContent, text.split(', ').map(Number)];
      }),
    ),
  );

const waitForRow = (viewer, title, value) =>
  viewer.page.waitForFunction(
    ([wanted, number]) =>
      [...window.qtetViewer.shadowRoot.querySelectorAll('.numbers > div')].some(
        ({children: [name, its]}) =>
          name.textContent === wanted &&
          Math.abs(Number(its.firstChild.textContent.replace('\u2212', '-')) - number) < 1e-3,
      ),
    [title, value],
  );

const set = (viewer, name, value) =>
  viewer.page.evaluate((words) => window.qtetViewer.setAttribute(...words), [name, value]);

/** A coarse level has another mean, and says how far it may be off. */
async function knowTheirError({server, browser}) {
  const viewer = await browser.open(
    `${server.url}?mesh=fin&field=Density&clip=none&quality=cells:3000`,
    kDesktop,
  );
  const {page} = viewer;
  await viewer.waitForState('held');
  await viewer.waitForPicture();
  await viewer.waitForControls();
  await page.locator('qtet-viewer summary', {hasText: 'Numbers'}).click();
  const mean = page.locator('qtet-viewer .numbers > div', {hasText: 'Mean of Density'});
  await mean.locator('small', {hasText: /^within [\d.]+$/}).waitFor();
  await page.locator('qtet-viewer .save-numbers').scrollIntoViewIfNeeded();
  await viewer.screenshot('numbers-coarse-light');
  const [near, text] = [(await rowsOf(viewer))['Mean of Density'][0], await mean.innerText()];
  await set(viewer, 'quality', 'full');
  await viewer.waitForState('complete');
  await viewer.settle();
  await page.waitForTimeout(kRestMs);
  const [right] = (await rowsOf(viewer))['Mean of Density'];
  assert.notEqual(right, near);
  assert.ok(Math.abs(right - near) <= Number(/within ([\d.]+)/.exec(text)[1]), text);
  await viewer.screenshot('numbers-whole-light');
  assert.deepEqual(viewer.problems, []);
  await browser.closePages();
}

async function areExact(context) {
  const {server, browser} = context;
  const Height = (x, y, z) => z;
  const U = (x, y, z) => [0, 0, z];
  await serveMesh(context, 'numbers', linearBox(3, {Height, U}));
  const viewer = await browser.openSettled(`${server.url}?mesh=numbers&field=Height`, kDesktop);
  const {page} = viewer;
  await page.locator('qtet-viewer summary', {hasText: 'Numbers'}).click();
  await waitForRow(viewer, 'Volume', 6);
  await waitForRow(viewer, 'Mean of Height', 1.5);
  await waitForRow(viewer, 'Standard deviation', 3 / Math.sqrt(12));
  await waitForRow(viewer, 'Largest', 3);
  await waitForRow(viewer, 'Area of the surface', 22);
  const force = (await rowsOf(viewer))['Height \u00d7 normal over the surface'];
  [0, 0, 6].forEach((its, i) => assert.ok(Math.abs(force[i] - its) < 1e-2, String(force)));
  await page.getByLabel('Flux of').selectOption('U');
  await waitForRow(viewer, 'Flux of U out of the surface', 6);
  assert.equal(new URL(page.url()).searchParams.get('flux'), 'U');
  await set(viewer, 'clip', 'z:0.5');
  await waitForRow(viewer, 'Volume', 3);
  await waitForRow(viewer, 'Mean on the cut', 1.5);
  await waitForRow(viewer, 'Flux of U through the cut, along +z', 3);
  await viewer.settle();
  await page.locator('qtet-viewer .save-numbers').scrollIntoViewIfNeeded();
  await viewer.screenshot('numbers-desktop-light');
  const [saved] = await Promise.all([
    page.waitForEvent('download'),
    page.locator('qtet-viewer .save-numbers').click(),
  ]);
  assert.equal(saved.suggestedFilename(), 'numbers_Height_numbers-clip-z-0.5.csv');
  const [titles, volume] = readFileSync(await saved.path(), 'utf8').split('\r\n');
  assert.equal(titles, '"quantity","value","unit","within","mesh","field"');
  assert.match(volume, /^"Volume",(3|2\.99\d+|3\.00\d+),"",,"numbers","Height"$/);
  await page.locator('qtet-viewer .scene').focus();
  await page.keyboard.press('Control+z');
  await waitForRow(viewer, 'Volume', 6);
  await page.keyboard.press('Control+z');
  await viewer.settle();
  assert.equal(await page.evaluate(() => window.qtetViewer.getAttribute('flux')), null);
  await set(viewer, 'threshold', 'Height=0,1');
  await waitForRow(viewer, 'Volume', 2);
  await set(viewer, 'field', 'U');
  await waitForRow(viewer, 'Mean of U, magnitude', 0.5);
  await waitForRow(viewer, 'Flux of U out of the surface', 2);
  assert.deepEqual(viewer.problems, []);
  await context.browser.closePages();

  await knowTheirError(context);
  const query = 'mesh=fin&field=Velocity.x&clip=y:0.5';
  for (const [name, device] of Object.entries({desktop: kDesktop, phone: kCoarsePhone})) {
    const again = await browser.openSettled(`${server.url}?${query}`, {
      ...device,
      colorScheme: 'dark',
    });
    if (name === 'phone') await again.page.getByRole('button', {name: 'Controls'}).click();
    await again.page.locator('qtet-viewer summary', {hasText: 'Numbers'}).click();
    await again.page.locator('qtet-viewer .numbers > div').first().waitFor();
    await again.page.locator('qtet-viewer .save-numbers').scrollIntoViewIfNeeded();
    await again.screenshot(`numbers-${name}-dark`);
    assert.deepEqual(await again.accessibilityViolations(), []);
    assert.deepEqual(again.problems, []);
    await context.browser.closePages();
  }
  return 'a box of 1 x 2 x 3: volume, means, areas, force and flux are exact';
}

/** The marks lie at the ends of a linear field, follow clips and fields, and are undone. */
async function markExtremes(context) {
  const {server, browser} = context;
  const Height = (x, y, z) => z;
  await serveMesh(context, 'marked', linearBox(3, {Height}));
  const textsOf = ({page}) => page.locator('qtet-viewer .pin button:first-child').allInnerTexts();
  const marked = (viewer, text) =>
    viewer.page.locator('qtet-viewer .pin', {hasText: text}).waitFor({state: 'attached'});
  const query = 'mesh=marked&field=Height&extremes=on&points=0.5,0,1';
  for (const [name, device] of Object.entries({desktop: kDesktop, phone: kCoarsePhone})) {
    const viewer = await browser.openSettled(`${server.url}?${query}`, device);
    const {page} = viewer;
    await marked(viewer, 'Largest 3.0');
    assert.equal((await textsOf(viewer)).length, 3);
    await viewer.screenshot(`extremes-${name}-light`);
    assert.deepEqual(await viewer.accessibilityViolations(), []);
    if (name === 'desktop') {
      await set(viewer, 'clip', 'z:0.5');
      await marked(viewer, 'Largest 1.5');
      await set(viewer, 'field', 'x');
      await marked(viewer, 'Largest 1.0');
      await page.waitForTimeout(kRestMs);
      await page.locator('qtet-viewer .scene').focus();
      await page.keyboard.press('m');
      await page.locator('qtet-viewer .pin', {hasText: 'Largest'}).waitFor({state: 'detached'});
      await page.waitForURL((url) => !url.searchParams.has('extremes'));
      await page.waitForTimeout(kRestMs);
      await page.keyboard.press('Control+z');
      await marked(viewer, 'Largest 1.0');
      await page.getByRole('button', {name: 'Remove largest'}).click();
      assert.equal(await page.getByLabel('Mark least and largest').isChecked(), false);
    }
    assert.deepEqual(viewer.problems, []);
    await browser.closePages();
  }
}

/** The texts of marks, kept points and lines, and the mean. */
const textsNow = ({page}) =>
  page.evaluate(() => {
    const {shadowRoot: root} = window.qtetViewer;
    const texts = (selector) => [...root.querySelectorAll(selector)].map((its) => its.textContent);
    return {
      pins: texts('.pin:not([hidden]) button:first-child'),
      table: texts('.kept output'),
      mean: texts('.numbers > div').find((its) => its.startsWith('Mean of Density')),
    };
  });

/** Each state that is seen is one instant's or one level's, and the last one is that of a stop. */
async function followTimeAndStream({server, browser, out, bin}) {
  makeLog(bin, 'played', out, ['fin', '--steps', '4', '--cells', '5000'], ['--fields', 'Density']);
  server.kill();
  await server.start();
  const kept = 'points=Tip:1,0.5,0.5&lines=Wake:0,0,0.2+3,1,1';
  const address = `${server.url}?field=Density&extremes=on&${kept}`;
  const open = async (query, state = 'complete') => {
    const viewer = await browser.open(`${address}&${query}`, kDesktop);
    await viewer.waitForState(state);
    await viewer.waitForPicture();
    await viewer.waitForControls();
    await viewer.page.locator('qtet-viewer summary', {hasText: 'Numbers'}).click();
    await viewer.page.locator('qtet-viewer .numbers > div').nth(1).waitFor();
    await viewer.page.waitForTimeout(kRestMs);
    return viewer;
  };
  const viewer = await open('mesh=played&time=0');
  const instants = [];
  for (const time of ['0', '1', '2', '3']) {
    await set(viewer, 'time', time);
    await viewer.settle();
    await viewer.page.waitForTimeout(kRestMs);
    instants.push(await textsNow(viewer));
  }
  assert.equal(new Set(instants.map(({pins}) => pins.join())).size, 4);
  await viewer.page.getByRole('button', {name: 'Play', exact: true}).press('Enter');
  const [seen, means] = [new Set(), new Set()];
  for (let i = 0; i < 40; ++i) {
    await viewer.page.waitForTimeout(100);
    const now = await textsNow(viewer);
    const at = instants.findIndex(({pins}) => pins.join() === now.pins.join());
    assert.ok(at >= 0, `no instant has ${now.pins.join()}`);
    assert.deepEqual(now.table, instants[at].table);
    seen.add(at);
    assert.ok(
      instants.some(({mean}) => mean === now.mean),
      now.mean,
    );
    means.add(now.mean);
  }
  assert.ok(seen.size > 2 && means.size > 1, `${seen.size} instants, ${means.size} means`);
  assert.deepEqual(viewer.problems, []);
  await browser.closePages();

  const coarse = await open('mesh=fin&quality=cells:3000', 'held');
  const before = await textsNow(coarse);
  await set(coarse, 'quality', 'full');
  await coarse.waitForState('complete');
  await coarse.settle();
  await coarse.page.waitForTimeout(kRestMs);
  const after = await textsNow(coarse);
  assert.deepEqual(coarse.problems, []);
  await browser.closePages();
  assert.notDeepEqual(after.pins, before.pins);
  assert.notEqual(after.mean, before.mean);
  assert.deepEqual(after, await textsNow(await open('mesh=fin')));
  return `${seen.size} of 4 instants were seen while they played`;
}

export const numberChecks = {
  numbersFollowTimeAndStream: followTimeAndStream,
  numbersMarkExtremes: markExtremes,
  numbersAreExact: areExact,
};
