// The histogram in the colour panel: its handles set the range, with a pointer and with keys.

import assert from 'node:assert/strict';
import {kCoarsePhone, kDesktop} from './browser.mjs';
import {differingShare} from './png.mjs';
import {makeLog, serveMesh} from './programs.mjs';
import {linearBox} from './volume_checks.mjs';

const opened = ({server, browser}, query, device) =>
  browser.openComplete(`${server.url}?${query}`, device);

const handle = (viewer, which) =>
  viewer.page.getByRole('slider', {name: `Value of the ${which} colour`});
const rangeOf = (viewer) => viewer.page.evaluate(() => window.qtetViewer.getAttribute('range'));

async function setsTheRangeByItsHandles(context) {
  const viewer = await opened(context, 'mesh=fin&field=Pressure&clip=none&range=full');
  const {page} = viewer;
  const low = handle(viewer, 'first');
  await low.waitFor();
  await viewer.settle();
  const before = {
    legend: await viewer.text('.legend-ticks'),
    picture: await viewer.screenshot('histogram-before'),
  };
  const {x, y, width, height} = await low.boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2 + 90, y + height / 2, {steps: 6});
  await page.mouse.up();
  await viewer.settle();
  const [from, to] = (await rangeOf(viewer)).split(',').map(Number);
  assert.equal(Number(await low.getAttribute('aria-valuenow')), from);
  assert.match(await low.getAttribute('aria-valuetext'), /^Pressure .*\d/);
  assert.notEqual(await viewer.text('.legend-ticks'), before.legend);
  const differing = differingShare(before.picture, await viewer.screenshot('histogram-dragged'));
  assert.ok(differing > 0.03, `only ${differing} of the picture changes`);
  // the handle has the focus: arrows move it, and no key lets it pass the other one
  await page.keyboard.press('ArrowLeft');
  await viewer.settle();
  const [stepped] = (await rangeOf(viewer)).split(',').map(Number);
  assert.ok(stepped < from, `${stepped} after ${from}`);
  await page.keyboard.press('End');
  await viewer.settle();
  const [last] = (await rangeOf(viewer)).split(',').map(Number);
  assert.ok(last < to && last > from, `${last} below ${to}`);
  await page.getByRole('button', {name: 'Middle 98'}).click();
  await viewer.settle();
  const middle = await rangeOf(viewer);
  assert.notEqual(middle, `${last},${to}`);
  await page.keyboard.press('Control+z');
  await viewer.settle();
  assert.equal(await rangeOf(viewer), `${last},${to}`);
  assert.deepEqual(await viewer.accessibilityViolations(), []);
  assert.deepEqual(viewer.problems, []);
  return `${from} to ${to}; the middle: ${middle}`;
}

/** A double-click takes the middle, too; the picture is also looked at in the dark. */
async function takesTheMiddleByADoubleClick(context) {
  const device = {...kDesktop, colorScheme: 'dark'};
  const viewer = await opened(context, 'mesh=fin&field=Pressure&clip=none&scale=log', device);
  await handle(viewer, 'first').waitFor();
  await viewer.screenshot('histogram-dark');
  await viewer.page.locator('qtet-viewer .histogram-plot').dblclick({position: {x: 90, y: 20}});
  await viewer.settle();
  assert.match(await rangeOf(viewer), /^[\d.]+,[\d.]+$/);
  assert.deepEqual(await viewer.accessibilityViolations(), []);
}

async function hasRoomForFingers(context) {
  const viewer = await opened(context, 'mesh=fin&field=Pressure&clip=none', kCoarsePhone);
  await viewer.page.getByRole('button', {name: 'Controls'}).tap();
  for (const which of ['first', 'last']) {
    await viewer.page.getByRole('button', {name: 'Middle 98'}).scrollIntoViewIfNeeded();
    const {width, height} = await handle(viewer, which).boundingBox();
    assert.ok(width >= 44 && height >= 44, `${width} x ${height}`);
  }
  await viewer.settle();
  assert.equal(await viewer.text('.histogram .what'), '√ of vertices');
  await viewer.screenshot('histogram-phone');
  assert.deepEqual(viewer.problems, []);
}

async function countsAwkwardFields(context) {
  const {server, browser} = context;
  await serveMesh(
    context,
    'counted',
    linearBox(4, {
      Even: (x) => x,
      Constant: () => 42.5,
      Missing: (x, y, z) => (z < 1 ? NaN : y),
      Decades: (x, y) => 10 ** (y / 2),
    }),
    ['--field-bits', '20'],
  );
  const viewer = await opened({server, browser}, 'mesh=counted&field=Even');
  const {page} = viewer;
  const bars = () => page.locator('qtet-viewer .histogram path').getAttribute('d');
  const countOf = async (field, scale = null) => {
    await page.evaluate(
      ([name, text]) => {
        window.qtetViewer.setAttribute('field', name);
        if (text) window.qtetViewer.setAttribute('scale', text);
        else window.qtetViewer.removeAttribute('scale');
      },
      [field, scale],
    );
    await viewer.settle();
    await viewer.settle();
    await viewer.screenshot(`histogram-${field}`);
    return {
      bars: (await bars()).split('M').length - 1,
      text: await viewer.text('.histogram .ends'),
    };
  };
  await handle(viewer, 'first').waitFor();
  assert.equal((await countOf('Even')).bars, 5);
  const constant = await countOf('Constant');
  assert.equal(constant.bars, 1);
  assert.match(constant.text, /^All 42\.5/);
  assert.equal(await handle(viewer, 'first').isVisible(), false);
  const missing = await countOf('Missing');
  assert.equal(missing.bars, 9);
  assert.doesNotMatch(missing.text, /NaN|missing/);
  const decades = await countOf('Decades', 'log');
  assert.equal(decades.bars, 9);
  assert.deepEqual(viewer.problems, []);
  return JSON.stringify({constant, missing, decades});
}

/** The histogram comes half a second after the panel, which keeps its place. */
async function comesWithoutMovingThePanel(context) {
  const {server, browser} = context;
  for (const [name, device] of Object.entries({desktop: kDesktop, phone: kCoarsePhone})) {
    const watch = () => {
      window.qtetPlaces = [];
      const look = () => {
        const root = window.qtetViewer?.shadowRoot;
        const plot = root?.querySelector('.histogram-plot');
        if (plot) {
          const {top} = root.querySelector('.histogram').getBoundingClientRect();
          const next = root.querySelector('input[name=edges]').closest('details');
          const isShown = getComputedStyle(plot).visibility === 'visible';
          window.qtetPlaces.push([isShown, Math.round(next.getBoundingClientRect().top - top)]);
        }
        requestAnimationFrame(look);
      };
      look();
    };
    const viewer = await browser.open(`${server.url}?mesh=fin&clip=none`, device, watch);
    await viewer.waitForState('complete');
    const {page} = viewer;
    if (device.isMobile) await page.getByRole('button', {name: 'Controls'}).tap();
    await viewer.screenshot(`histogram-awaited-${name}`);
    await handle(viewer, 'first').waitFor();
    await viewer.settle();
    const places = await page.evaluate(() => window.qtetPlaces);
    const here = (isShown) =>
      new Set(places.filter(([its, at]) => its === isShown && at > 0).map(([, at]) => at));
    assert.ok(here(false).size > 0, 'the histogram was never awaited');
    assert.deepEqual([...here(false)], [...here(true)]);
    assert.deepEqual(viewer.problems, []);
  }
}

/** While a series plays, another field is counted, and the handles set its range. */
async function countsAnotherFieldWhileASeriesPlays(context) {
  const {server, bin, out} = context;
  makeLog(bin, 'counting', out, ['fin', '--steps', '4'], ['--measure', 'none']);
  server.kill();
  await server.start();
  const viewer = await opened(context, 'mesh=counting&field=Density&clip=none');
  const {page} = viewer;
  const low = handle(viewer, 'first');
  await low.waitFor();
  const title = () => low.getAttribute('aria-valuetext');
  assert.match(await title(), /^Density/);
  await page.evaluate(() => {
    window.qtetViewer.playing = true;
    window.qtetViewer.setAttribute('field', 'Pressure');
  });
  await page.waitForFunction(() =>
    window.qtetViewer.shadowRoot
      .querySelector('.histogram .end')
      .getAttribute('aria-valuetext')
      .startsWith('Pressure'),
  );
  assert.equal(await page.evaluate(() => window.qtetViewer.playing), true);
  assert.equal(await page.locator('qtet-viewer select[name=field]').inputValue(), 'Pressure');
  const [from, to] = await Promise.all(
    ['valuemin', 'valuemax'].map(async (name) => Number(await low.getAttribute(`aria-${name}`))),
  );
  await viewer.screenshot('histogram-playing');
  await low.focus();
  await page.keyboard.press('Shift+ArrowRight');
  await viewer.settle();
  const [set] = (await rangeOf(viewer)).split(',').map(Number);
  assert.ok(set > from && set < to, `${set} is not within ${from} and ${to}`);
  assert.equal(Number(await low.getAttribute('aria-valuenow')), set);
  assert.deepEqual(viewer.problems, []);
  return `${await title()} of ${from} to ${to}`;
}

export const histogramChecks = {
  comesWithoutMovingThePanel,
  countsAnotherFieldWhileASeriesPlays,
  setsTheRangeByItsHandles,
  takesTheMiddleByADoubleClick,
  hasRoomForFingers,
  countsAwkwardFields,
};
