// Points that are kept on the mesh, each with a small card.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {kCoarsePhone, kDesktop} from './browser.mjs';
import {serveMesh} from './programs.mjs';
import {linearBox} from './volume_checks.mjs';

/** Longer than changes that are one step lie apart. */
const kStepMs = 400;

const opened = ({server, browser}, query, device) =>
  browser.openSettled(`${server.url}?${query}`, device);

/** The cards: text, colour, and the middle of the dot. */
const pinsOf = (viewer) =>
  viewer.page.evaluate(() =>
    [...window.qtetViewer.shadowRoot.querySelectorAll('.pin:not([hidden])')].map((pin) => {
      const {left, top, width, height} = pin.querySelector('i').getBoundingClientRect();
      return {
        text: pin.querySelector('button').textContent,
        color: getComputedStyle(pin.querySelector('i')).backgroundColor,
        edge: getComputedStyle(pin.querySelector('div')).borderLeftColor,
        at: [left + width / 2, top + height / 2],
      };
    }),
  );

const pointsOf = (viewer) => viewer.page.evaluate(() => window.qtetViewer.getAttribute('points'));

/** Points stay where they were kept, follow camera and field, and close one by one. */
async function keepsSeveralPoints(context) {
  const viewer = await opened(context, 'mesh=fin&field=Density&clip=y:0.5', kDesktop);
  const {page} = viewer;
  await page.getByText('Point', {exact: true}).click();
  const places = [
    [560, 380],
    [640, 420],
  ];
  for (const [x, y] of places) {
    await page.mouse.click(x, y);
    await page.locator('qtet-viewer .result').waitFor();
    assert.match(await viewer.text('.result h2'), /^Density [\d.]+$/);
    await viewer.screenshot('pins-card');
    await page.getByRole('button', {name: 'Keep', exact: true}).click();
    await page.locator('qtet-viewer .result').waitFor({state: 'hidden'});
  }
  await viewer.settle();
  const pins = await pinsOf(viewer);
  assert.equal(pins.length, 2);
  pins.forEach(({text, color, edge, at}, i) => {
    assert.match(text, /^[\d.]+$/);
    assert.equal(color, edge);
    const away = Math.hypot(at[0] - places[i][0], at[1] - places[i][1]);
    assert.ok(away < 3, `point ${i} lies ${away} pixels from where it was kept`);
  });
  assert.notEqual(pins[0].color, pins[1].color);
  await viewer.screenshot('pins-desktop-light');
  await page.evaluate(() => window.qtetViewer.setAttribute('field', 'Pressure'));
  await viewer.settle();
  assert.notEqual((await pinsOf(viewer))[0].text, pins[0].text);
  await page.locator('qtet-viewer .scene').focus();
  await page.keyboard.press('ArrowLeft');
  await viewer.settle();
  assert.notDeepEqual((await pinsOf(viewer))[0].at, pins[0].at);
  const link = await pointsOf(viewer);
  await page.waitForURL(/points=/);
  await page.locator('qtet-viewer .pins').getByRole('button', {name: 'Remove point 1'}).click();
  await viewer.settle();
  assert.equal(await pointsOf(viewer), link.split(' ')[1]);
  await page.locator('qtet-viewer .scene').focus();
  await page.keyboard.press('Control+z');
  await viewer.settle();
  assert.equal(await pointsOf(viewer), link);
  assert.deepEqual(viewer.problems, []);
  await context.browser.closePages();
  for (const [name, device] of Object.entries({desktop: kDesktop, phone: kCoarsePhone})) {
    const query = `mesh=fin&field=Density&clip=y:0.5&points=${encodeURIComponent(link)}`;
    const again = await opened(context, query, {...device, colorScheme: 'dark'});
    const shown = await pinsOf(again);
    assert.equal(shown.length, 2);
    assert.deepEqual(
      shown.map(({text}) => text),
      pins.map(({text}) => text),
    );
    await again.screenshot(`pins-${name}-dark`);
    assert.deepEqual(await again.accessibilityViolations(), []);
    assert.deepEqual(again.problems, []);
    await context.browser.closePages();
  }
}

/** A point belongs to the mesh at rest: a warp moves it, and not its value. */
async function movesPointsWithAWarp(context) {
  const Displacement = (x, y, z) => [0.4 * z, 0, 0];
  const Height = (x, y, z) => z;
  await serveMesh(context, 'pinned', linearBox(3, {Displacement, Height}));
  const viewer = await opened(
    context,
    'mesh=pinned&field=Height&warp=Displacement&warp-scale=1&points=0.5,0,0.5',
    kDesktop,
  );
  const [pin] = await pinsOf(viewer);
  const moved = await viewer.page.evaluate(() => {
    const {meshView, viewing} = window.qtetViewer;
    const {origin, step} = viewing.mesh.manifest.lattice;
    return meshView.project([0.7, 0, 0.5].map((x, axis) => (x - origin[axis]) / step));
  });
  const away = Math.hypot(pin.at[0] - moved.x, pin.at[1] - moved.y);
  assert.ok(away < 3, `the point lies ${away} pixels from where it is moved`);
  assert.ok(Math.abs(Number(pin.text) - 0.5) < 0.01, pin.text);
  await viewer.screenshot('pins-warped');
  await followsThePicture(viewer, pin.at);
  assert.deepEqual(viewer.problems, []);
}

/** Another picture comes under a pointer that rests, and while a card is open. */
async function followsThePicture({page}, [x, y]) {
  const row = (name) =>
    page.locator('qtet-viewer .result dl div', {hasText: name}).first().locator('dd').innerText();
  const show = (name, value) =>
    page.evaluate((words) => window.qtetViewer.setAttribute(...words), [name, value]);
  const hovered = (text) => page.locator('qtet-viewer .hover', {hasText: text}).waitFor();
  await page.mouse.move(x - 20, y);
  await hovered('Height');
  await show('field', 'Displacement');
  await hovered('Displacement');
  await page.getByText('Point', {exact: true}).click();
  await page.mouse.click(x - 20, y);
  await page.locator('qtet-viewer .result').waitFor();
  const [moved, rest] = [await row('Position'), await row('Position at rest')];
  await show('warp-scale', '0.5');
  await page.waitForFunction(
    (before) =>
      !window.qtetViewer.shadowRoot.querySelector('.result dl').textContent.includes(before),
    moved,
  );
  const [now, atRest] = [await row('Position'), await row('Position at rest')];
  assert.equal(atRest, rest);
  const [before, after, still] = [moved, now, rest].map((text) => Number(text.split(',')[0]));
  assert.ok(Math.abs(after - still - (before - still) / 2) < 0.01, `${moved} ${now} ${rest}`);
}

/** Cards of close points cover neither one another nor a dot. Those without room are folded. */
async function findsRoomForCardsOnAPhone(context) {
  const at = (...places) => places.map(([x, y, z]) => `${x},${y},${z}`).join(' ');
  const Height = (x, y, z) => z;
  await serveMesh(context, 'close', linearBox(3, {Height}));
  const two = at([0.5, 0, 0.5], [0.53, 0, 0.5]);
  const viewer = await opened(
    context,
    `mesh=close&field=Height&points=${encodeURIComponent(two)}`,
    kCoarsePhone,
  );
  const {page} = viewer;
  await viewer.screenshot('pins-close-phone');
  assert.equal((await cardsOf(viewer)).length, 2);
  assert.deepEqual(await overlapsOf(viewer), []);
  await tapPoint(viewer, 2);
  assert.match(await viewer.text('.result h2'), /^Height 0\.5/);
  assert.equal(await page.getByRole('button', {name: 'Keep', exact: true}).count(), 0);
  await viewer.screenshot('pins-tapped-phone');
  await page.locator('qtet-viewer .close-result').click();
  const many = at(...Array.from({length: 8}, (_, i) => [0.5 + 0.003 * i, 0, 0.5]));
  await page.evaluate((points) => window.qtetViewer.setAttribute('points', points), many);
  await viewer.settle();
  await viewer.screenshot('pins-folded-phone');
  const cards = await cardsOf(viewer);
  assert.ok(cards.length >= 1 && cards.length < 8, `${cards.length} cards have room`);
  assert.ok(cards.includes(8), 'the newest card has room');
  assert.deepEqual(await overlapsOf(viewer), []);
  assert.deepEqual(await viewer.accessibilityViolations(), []);
  assert.deepEqual(viewer.problems, []);
}

const attribute = ({page}, name) =>
  page.evaluate((its) => window.qtetViewer.getAttribute(its), name);

const setAttribute = ({page}, name, value) =>
  page.evaluate((words) => window.qtetViewer.setAttribute(...words), [name, value]);

/** Names are edited, a line is kept, and rows are removed by keys. All of it is undone. */
async function listsKeptPointsAndLines(context) {
  const {browser} = context;
  const Height = (x, y, z) => z;
  const U = (x, y, z) => [x, y, z];
  await serveMesh(context, 'listed', linearBox(3, {Height, U}));
  const points = 'Tip: 0.5,0,0.5; 0.5,0,2.5; <i>Foot</i>: 0.5,1,0.5';
  const lines = 'Wall: 0.5,0,0.5 0.5,0,2.5';
  const query = `mesh=listed&field=Height&points=${encodeURIComponent(points)}&lines=${lines}`;
  const viewer = await opened(context, query, kDesktop);
  const {page} = viewer;
  const table = page.locator('qtet-viewer .kept');
  const row = (title, value) =>
    table.locator('dl div', {hasText: title}).filter({hasText: value}).waitFor();
  await row('Distance from Tip to Point 2', '2.0000');
  await row('Angle at Point 2, from Tip to <i>Foot</i>', '26.565');
  assert.deepEqual(
    (await pinsOf(viewer)).map(({text}) => text),
    ['Tip 0.5000', '2.5000', '<i>Foot</i> 0.5000', 'Wall 2.0000\nmean 1.5000\n0.5000 to 2.5000'],
  );
  const name = page.getByLabel('Name of point 2');
  await name.fill(' Root;\u202e ');
  await name.press('Enter');
  assert.equal(await attribute(viewer, 'points'), points.replace('; 0', '; Root: 0'));
  await row('Distance from Tip to Root', '2.0000');
  assert.equal((await pinsOf(viewer))[1].text, 'Root 2.5000');
  assert.equal(await name.inputValue(), 'Root');
  for (const which of ['Tip', '<i>Foot</i>']) await page.getByLabel(`Measure ${which}`).check();
  await row('Distance from Tip to <i>Foot</i>', '1.0000');
  await viewer.settle();
  await table.locator('.save-kept').scrollIntoViewIfNeeded();
  await viewer.screenshot('kept-desktop-light');
  assert.deepEqual(await viewer.accessibilityViolations(), []);
  await page.getByLabel('All fields in copies').check();
  for (const field of ['U', 'Height']) {
    await setAttribute(viewer, 'field', field);
    await viewer.settle();
  }
  const [saved] = await Promise.all([
    page.waitForEvent('download'),
    table.locator('.save-kept').click(),
  ]);
  assert.equal(saved.suggestedFilename(), 'listed_Height_kept.csv');
  const csv = readFileSync(await saved.path(), 'utf8');
  assert.match(csv, /^"quantity","value","unit","within","mesh","field"\r\n"Place of Tip, x",0.5,/);
  assert.match(csv, /"Value of U, magnitude at Root",2.5\d*,/);
  assert.match(csv, /"Mean of Height along Wall",1.[45]\d*,"",\d/);

  const remove = (title) => table.getByRole('button', {name: `Remove ${title}`});
  await remove('Root').press('Enter');
  await page.waitForTimeout(kStepMs);
  await remove('<i>Foot</i>').press('Enter');
  assert.equal(await attribute(viewer, 'points'), 'Tip: 0.5,0,0.5');
  assert.equal(await viewer.page.evaluate(focusedLabel), 'Remove Wall');
  await viewer.settle();
  for (const left of [
    'Tip: 0.5,0,0.5; <i>Foot</i>: 0.5,1,0.5',
    points.replace('; 0', '; Root: 0'),
  ]) {
    await page.locator('qtet-viewer .scene').focus();
    await page.keyboard.press('Control+z');
    await viewer.settle();
    assert.equal(await attribute(viewer, 'points'), left);
  }
  await keepsALine(viewer);
  await setAttribute(viewer, 'points', 'Tip: 0.5,0,0.5; Wrong');
  await page.getByText('is not understood').waitFor();
  await browser.closePages();

  const phone = await opened(context, query, {...kCoarsePhone, colorScheme: 'dark'});
  await phone.page.getByRole('button', {name: 'Controls'}).click();
  await phone.page.locator('qtet-viewer .kept li').first().waitFor();
  await phone.page.locator('qtet-viewer .kept').scrollIntoViewIfNeeded();
  await phone.screenshot('kept-phone-dark');
  const isWide = await phone.page.evaluate(() => {
    const {scrollWidth, clientWidth} = window.qtetViewer.shadowRoot.querySelector('.kept');
    return scrollWidth > clientWidth;
  });
  assert.ok(!isWide, 'the table is wider than the phone');
  assert.deepEqual(await phone.accessibilityViolations(), []);
  assert.deepEqual(phone.problems, []);
}

const focusedLabel = () => window.qtetViewer.shadowRoot.activeElement.ariaLabel;

/** The line tool's card keeps it. A click on the kept line's value opens that card again. */
async function keepsALine(viewer) {
  const {page} = viewer;
  const keep = page.getByRole('button', {name: 'Keep', exact: true});
  await page.locator('qtet-viewer .tools').getByText('Line', {exact: true}).click();
  const ends = await page.evaluate(() => {
    const {meshView, viewing} = window.qtetViewer;
    const {origin, step} = viewing.mesh.manifest.lattice;
    return [1, 2].map((z) =>
      meshView.project([0.9, 0, z].map((x, axis) => (x - origin[axis]) / step)),
    );
  });
  for (const {x, y} of ends) await page.mouse.click(x, y);
  await keep.click();
  await page.locator('qtet-viewer .result').waitFor({state: 'hidden'});
  const [wall, kept] = (await attribute(viewer, 'lines')).split('; ');
  assert.equal(wall, 'Wall: 0.5,0,0.5 0.5,0,2.5');
  assert.equal(kept.split(' ').length, 2);
  const value = page.locator('qtet-viewer .pin button', {hasText: 'Line B'});
  await value.waitFor();
  const [, length] = /^Line B ([\d.]+)/.exec(await value.innerText());
  assert.ok(Math.abs(Number(length) - 1) < 0.05, length);
  await value.press('Enter');
  await page.locator('qtet-viewer .result', {hasText: `Distance${length}`}).waitFor();
  assert.equal(await keep.count(), 0);
  await page.locator('qtet-viewer .close-result').click();
  await page.getByText('Turn', {exact: true}).click();
}

/** The numbers of the points whose cards are open. */
const cardsOf = (viewer) =>
  viewer.page.evaluate(() =>
    [...window.qtetViewer.shadowRoot.querySelectorAll('.pin:not(.folded) i')].map((its) =>
      Number(its.textContent),
    ),
  );

/** Pairs of open cards that overlap, cards over a dot's middle, and cards that leave the viewer. */
const overlapsOf = (viewer) =>
  viewer.page.evaluate(() => {
    const boxes = (selector) =>
      [...window.qtetViewer.shadowRoot.querySelectorAll(selector)].map((its) =>
        its.getBoundingClientRect(),
      );
    const cards = boxes('.pin:not(.folded) > div');
    const dots = boxes('.pin i').map(({left, top, width, height}) => ({
      left: left + width / 2,
      right: left + width / 2,
      top: top + height / 2,
      bottom: top + height / 2,
    }));
    const overlap = (a, b) =>
      a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    return cards.flatMap((card, i) => [
      ...cards.slice(i + 1).flatMap((other, k) => (overlap(card, other) ? [[i, i + 1 + k]] : [])),
      ...dots.flatMap((dot, k) => (overlap(card, dot) ? [`card ${i} over dot ${k}`] : [])),
      ...(card.left < 0 || card.right > innerWidth ? [`card ${i} leaves the viewer`] : []),
    ]);
  });

async function tapPoint(viewer, number) {
  const [x, y] = (await pinsOf(viewer))[number - 1].at;
  await viewer.page.touchscreen.tap(x, y);
  await viewer.page.locator('qtet-viewer .result').waitFor();
}

export const pinChecks = {
  pinsFindRoomOnAPhone: findsRoomForCardsOnAPhone,
  pinsAreListed: listsKeptPointsAndLines,
  pinsKeepSeveralPoints: keepsSeveralPoints,
  pinsMoveWithAWarp: movesPointsWithAWarp,
};
