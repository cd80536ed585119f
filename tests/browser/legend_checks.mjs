// Fields that are awkward to show: names, numbers and missing values must stay readable.

import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {kCoarsePhone, kSmallDesktop} from './browser.mjs';
import {serveMesh} from './programs.mjs';
import {linearBox, pixelsAt} from './volume_checks.mjs';

const kLong = 'Turbulent kinetic energy dissipation rate per unit mass, averaged in time';

/** The rectangles of the legend and of its numbers. */
const placesOf = (viewer) =>
  viewer.page.evaluate(() => {
    const {shadowRoot} = window.qtetViewer;
    const rectangle = (element) => {
      const {left, right, top, bottom} = element.getBoundingClientRect();
      return {left, right, top, bottom, text: element.textContent};
    };
    return {
      card: rectangle(shadowRoot.querySelector('.legend')),
      ticks: [...shadowRoot.querySelectorAll('.legend-ticks span')].map(rectangle),
    };
  });

async function showsAwkwardFieldsLegibly(context) {
  const {server, browser} = context;
  await serveMesh(
    context,
    'awkward',
    linearBox(4, {
      Offset: (x, y, z) => 101325 + 0.03 * z,
      Tiny: (x) => 1e-9 * x,
      Constant: () => 42.5,
      Missing: (x, y, z) => (z < 1 ? NaN : y),
      [kLong]: (x, y) => y,
    }),
    ['--field-bits', '20'],
  );
  const viewer = await browser.open(`${server.url}?mesh=awkward`, kCoarsePhone);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  for (const field of ['Offset', 'Tiny', 'Constant', 'Missing', kLong]) {
    await page.evaluate((name) => window.qtetViewer.setAttribute('field', name), field);
    await page.waitForFunction(
      (name) => window.qtetViewer.shadowRoot.querySelector('.legend-name').title === name,
      field,
    );
    await viewer.settle();
    const {card, ticks} = await placesOf(viewer);
    assert.ok(
      ticks.length > 0 && ticks.every(({left, right}) => left >= card.left && right <= card.right),
      `${field}: ${JSON.stringify(ticks)} in ${JSON.stringify(card)}`,
    );
    for (let i = 1; i < ticks.length; ++i)
      assert.ok(
        ticks[i].left > ticks[i - 1].right,
        `${field}: "${ticks[i - 1].text}" and "${ticks[i].text}" overlap`,
      );
    assert.equal(
      await page.locator('qtet-viewer .legend-missing').isVisible(),
      field === 'Missing',
      field,
    );
    await viewer.screenshot(`legend-${field.slice(0, 8).toLowerCase()}`);
  }
  // A tap moves nothing: the mesh stays fitted to the free space. Moving a finger turns it.
  await page.touchscreen.tap(195, 350);
  await viewer.settle();
  assert.equal(await viewer.inView(({camera}) => camera.orbit.fitted), true);
  await page.mouse.move(195, 350);
  await page.mouse.down();
  await page.mouse.move(260, 350, {steps: 3});
  await page.mouse.up();
  await viewer.settle();
  assert.equal(await viewer.inView(({camera}) => camera.orbit.fitted), false);
  assert.deepEqual(viewer.problems, []);
}

/**
 * In a low window, or one at 200 %, the legend is nearly as wide as the free space. So the mesh
 * must stand above it.
 */
async function keepsTheMeshOutOfTheLegend({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=box`, {
    viewport: {width: 720, height: 450},
    deviceScaleFactor: 2,
  });
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  await viewer.settle();
  const {card} = await placesOf(viewer);
  const lowest = await viewer.page.evaluate(() => {
    const {meshView, viewing} = window.qtetViewer;
    const {bounds} = viewing.mesh.base;
    return Math.max(
      ...Array.from(
        {length: 8},
        (_, i) => meshView.project([0, 1, 2].map((axis) => bounds[axis + 3 * ((i >> axis) & 1)])).y,
      ),
    );
  });
  assert.ok(lowest < card.top, `the mesh reaches down to ${lowest}, the legend up to ${card.top}`);
  await viewer.screenshot('legend-low');
}

/** The plot along a short line across the middle of the mesh, once it is drawn. */
async function plotAcrossTheMiddle(viewer) {
  const {page} = viewer;
  await page.getByText('Line', {exact: true}).click();
  const {x, y} = await page.evaluate(() => {
    const {bounds} = window.qtetViewer.viewing.mesh.base;
    const middle = [0, 1, 2].map((axis) => (bounds[axis] + bounds[axis + 3]) / 2);
    return window.qtetViewer.meshView.project(middle);
  });
  await page.mouse.click(x - 40, y);
  await viewer.settle();
  await page.mouse.click(x + 40, y);
  const plot = page.locator('qtet-viewer .plot');
  await plot.locator('canvas').waitFor();
  return plot;
}

/** A range's numbers and a plot's curve belong to the field that is shown. */
async function followsTheField({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&field=Density&range=1,2`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  const attribute = (name) => page.evaluate((its) => window.qtetViewer.getAttribute(its), name);
  const field = page.locator('qtet-viewer select[name=field]');
  await field.selectOption('Pressure');
  assert.equal(await attribute('range'), null);
  await field.selectOption('Density');
  assert.equal(await attribute('range'), '1,2');
  await viewer.settle();

  const plot = await plotAcrossTheMiddle(viewer);
  await viewer.settle();
  assert.equal(await plot.getAttribute('aria-label'), 'Density along the line');
  const covered = await page.evaluate(() => {
    const {shadowRoot} = window.qtetViewer;
    const {left, top, right, bottom} = shadowRoot.querySelector('.result').getBoundingClientRect();
    return {
      card: {left, top, right, bottom},
      marks: [...shadowRoot.querySelectorAll('.marks circle')].map((mark) =>
        ['cx', 'cy'].map((name) => Number(mark.getAttribute(name))),
      ),
    };
  });
  assert.equal(covered.marks.length, 2);
  const {card} = covered;
  assert.ok(
    covered.marks.every(
      ([x, y]) => x < card.left || x > card.right || y < card.top || y > card.bottom,
    ),
    JSON.stringify(covered),
  );
  await field.selectOption('Pressure');
  await page.waitForFunction(
    () =>
      window.qtetViewer.shadowRoot.querySelector('.plot').getAttribute('aria-label') ===
      'Pressure along the line',
  );
  await viewer.screenshot('plot-follows');
}

/** The legend states what a scale or a surface hides, at the place where it is chosen. */
async function saysWhatIsHidden({server, browser}) {
  const viewer = await browser.open(
    `${server.url}?mesh=fin&field=Velocity[1]&scale=log&iso=Density=1.5&clip=1,1,0:0.9`,
    kSmallDesktop,
  );
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  assert.match(await viewer.text('.legend-note'), /^Linear from −?[\d.]+ to [\d.]+$/);
  const hint = page.locator('qtet-viewer .iso-hidden');
  assert.ok(await hint.isHidden(), 'a cut shows what is inside');
  const select = page.locator('qtet-viewer .plane:first-child select');
  assert.equal(await select.inputValue(), 'free');
  const {scrollWidth, clientWidth} = await select.evaluate((box) => ({
    scrollWidth: box.scrollWidth,
    clientWidth: box.clientWidth,
  }));
  assert.ok(clientWidth > 90 && scrollWidth <= clientWidth, `"Free" has ${clientWidth} pixels`);
  await page.evaluate(() => {
    window.qtetViewer.removeAttribute('clip');
    window.qtetViewer.removeAttribute('scale');
  });
  await hint.waitFor();
  assert.ok(await page.locator('qtet-viewer .legend-note').isHidden());
  await page.getByRole('button', {name: 'See through it'}).click();
  await hint.waitFor({state: 'hidden'});
  const working = await page.evaluate(() => {
    const mark = window.qtetViewer.shadowRoot.querySelector('.working');
    const seen = (window.qtetWorking = []);
    new MutationObserver(() => seen.push(!mark.hidden)).observe(mark, {attributes: true});
    // dense, so that a ray is short
    window.qtetViewer.setAttribute('volume', '0.9,0.9,0.9');
    return mark.hidden;
  });
  assert.equal(working, true);
  await viewer.restVolume();
  await viewer.settle();
  const seen = await page.evaluate(() => window.qtetWorking);
  assert.ok(seen.includes(true) && seen.at(-1) === false, `the volume said ${seen}`);
}

/** The keyboard does everything that a mouse does with two buttons and a wheel. */
async function movesAndCentresByKeys({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=box`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  const places = () =>
    page.evaluate(() => {
      const {meshView, viewing} = window.qtetViewer;
      const {bounds} = viewing.mesh.base;
      const point = viewing.later?.panels.inspect.pointed;
      const [x, y] = viewing.controls.shell.cards.middle;
      return {
        mesh: meshView.project([0, 1, 2].map((axis) => (bounds[axis] + bounds[axis + 3]) / 2)),
        point: point && meshView.project(point),
        middle: {x: x * meshView.canvas.clientWidth, y: y * meshView.canvas.clientHeight},
        fitted: meshView.pose.fitted,
      };
    });
  await page.locator('qtet-viewer .scene').focus();
  const before = await places();
  await page.keyboard.press('Shift+ArrowRight');
  await page.keyboard.press('Shift+ArrowUp');
  await viewer.settle();
  const moved = await places();
  const share = 0.08 * 800;
  assert.ok(Math.abs(moved.mesh.x - before.mesh.x - share) < 12, JSON.stringify([before, moved]));
  assert.ok(Math.abs(before.mesh.y - moved.mesh.y - share) < 12, JSON.stringify([before, moved]));
  await page.keyboard.press('i');
  await viewer.settle();
  await page.keyboard.press('Shift+ArrowLeft');
  await page.keyboard.press('f');
  await viewer.settle();
  const {point, middle} = await places();
  const away = Math.hypot(point.x - middle.x, point.y - middle.y);
  assert.ok(away < 3, `what was pointed at lies ${away} pixels from the middle`);
  await page.keyboard.press('Home');
  await viewer.settle();
  assert.equal((await places()).fitted, true);
  assert.deepEqual(viewer.problems, []);
}

/** The numbers at the pointer can be taken along. */
async function givesItsNumbersAway({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&field=Density`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  await page.evaluate(() => {
    window.qtetCopied = [];
    Object.defineProperty(navigator, 'clipboard', {
      value: {writeText: async (text) => void window.qtetCopied.push(text)},
    });
  });
  await plotAcrossTheMiddle(viewer);
  const saved = page.waitForEvent('download');
  await page.getByRole('button', {name: 'Save as CSV'}).click();
  const download = await saved;
  assert.match(download.suggestedFilename(), /^fin_Density_line-[-\d.]+-to-[-\d.]+\.csv$/);
  const rows = readFileSync(await download.path(), 'utf8').split('\r\n');
  assert.equal(rows[0], '"distance","x","y","z","Density","mesh"');
  assert.ok(rows.length > 2, `${rows.length} rows`);
  for (const row of rows.slice(1)) assert.match(row, /^([-\d.e]+,){4}[-\d.e]*,"fin"$/);
  const places = rows.slice(1).map((row) => row.split(',').slice(0, 4).map(Number));
  places.slice(1).forEach(([at, ...position], i) => {
    const [before, ...from] = places[i];
    assert.ok(at > before, `${at} after ${before}`);
    const step = Math.hypot(...position.map((x, axis) => x - from[axis]));
    assert.ok(Math.abs(step - (at - before)) < 1e-6 * places.at(-1)[0], `${rows[i + 2]}`);
  });
  await page.getByRole('button', {name: 'Copy', exact: true}).click();
  const copied = await page.evaluate(() => window.qtetCopied);
  assert.match(copied[0], /^Distance\t[\d.]+\nDifference\t/);
}

/** A logarithm of both signs: linear to a thousandth of the larger end, then decades. */
async function coloursBothSidesOfZero(context) {
  const {server, browser} = context;
  const nodes = [-1000, -10, 0, 10, 1000];
  const signed = (x) => {
    const cell = Math.min(3, Math.floor(4 * x));
    return nodes[cell] + (4 * x - cell) * (nodes[cell + 1] - nodes[cell]);
  };
  await serveMesh(context, 'signed', linearBox(4, {Signed: signed}), ['--field-bits', '20']);
  const viewer = await browser.open(
    `${server.url}?mesh=signed&field=Signed&scale=log&colormap=grey&clip=y:0.5&clip-mode=slice` +
      '&edges=off&projection=parallel',
  );
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  assert.equal(await viewer.text('.legend-note'), 'Linear from −1.0000 to 1.0000');
  await viewer.page.evaluate(() => window.qtetViewer.look('-y'));
  await viewer.settle();
  const bent = (value) => (value < 0 ? -1 : 1) * (1 + Math.log(Math.abs(value)));
  const shares = [0.05, 0.2, 0.3, 0.45, 0.55, 0.7, 0.8, 0.97];
  const pixels = await pixelsAt(
    viewer,
    shares.map((x) => [x, 0.5, 0.37]),
  );
  const greys = shares.map((x) => {
    const place = (bent(signed(x)) - bent(-1000)) / (bent(1000) - bent(-1000));
    return 26 + place * 210; // from one end of the map to the other
  });
  pixels.forEach(([grey], i) =>
    assert.ok(Math.abs(grey - greys[i]) < 3, `${grey} instead of ${greys[i]} at ${shares[i]}`),
  );
  await viewer.screenshot('legend-signed');
}

/** A label has a list of its values instead of a bar, and its error is a share of the volume. */
async function listsLabels(context) {
  const {server, browser} = context;
  const n = 4;
  const count = 6 * n * (2 * n) * (3 * n);
  // Two parts in each of six slabs: multiples of 100, as parts often have them.
  const partOf = (cell) => {
    const x = Math.floor(cell / 6) % n;
    const z = Math.floor(cell / (6 * n * 2 * n));
    return 100 * (2 * Math.floor(z / 2) + (x < n / 2 ? 1 : 2));
  };
  const values = Array.from({length: count}, (_, cell) => partOf(cell)).join(' ');
  const part = `<DataArray type="Int32" Name="Part" format="ascii">${values}</DataArray>`;
  const mesh = linearBox(n).replace('<Points>', `<CellData>${part}</CellData><Points>`);
  await serveMesh(context, 'parts', mesh);
  const viewer = await browser.open(`${server.url}?mesh=parts&field=Part`, kSmallDesktop);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  const list = page.locator('qtet-viewer .legend').getByRole('list');
  const rows = list.getByRole('listitem');
  assert.deepEqual(
    await rows.allTextContents(),
    Array.from({length: 12}, (_, i) => String(100 * (i + 1))),
  );
  assert.ok(await page.locator('qtet-viewer .legend-bar').isHidden());
  const colors = await list
    .locator('i')
    .evaluateAll((its) => its.map((swatch) => swatch.style.background));
  assert.equal(new Set(colors).size, 12, `${colors}`);
  assert.match(await viewer.text('.error-left'), /^[\d.]+\u202f% of the volume$/);
  await viewer.screenshot('legend-labels');
  await page.evaluate(() => window.qtetViewer.setAttribute('field', 'x'));
  await list.waitFor({state: 'hidden'});
  assert.doesNotMatch(await viewer.text('.error-left'), /volume/);
  assert.deepEqual(viewer.problems, []);
}

/** A few high values would take the colours of all others. */
async function opensTheEndsOfACutRange(context) {
  const {server, browser} = context;
  const values = {Even: (x) => x, Skewed: (x, y, z) => ((x * y * z) / 6) ** 16};
  await serveMesh(context, 'skewed', linearBox(3, values));
  const viewer = await browser.open(`${server.url}?mesh=skewed&field=Skewed`, kSmallDesktop);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  const ends = () =>
    page.locator('qtet-viewer .legend-bar').evaluate((bar) => [...bar.classList].slice(1));
  assert.deepEqual(await ends(), ['open-above']);
  assert.match(await viewer.text('.legend-note'), /^Middle 96\u202f% by volume; arrows/);
  await viewer.screenshot('legend-open');
  await page.evaluate(() => window.qtetViewer.setAttribute('range', 'full'));
  await viewer.settle();
  assert.deepEqual(await ends(), []);
  await page.evaluate(() => window.qtetViewer.removeAttribute('range'));
  await page.evaluate(() => window.qtetViewer.setAttribute('field', 'Even'));
  await viewer.settle();
  assert.deepEqual(await ends(), []);
  assert.deepEqual(viewer.problems, []);
}

export const legendChecks = {
  opensTheEndsOfACutRange,
  listsLabels,
  coloursBothSidesOfZero,
  movesAndCentresByKeys,
  givesItsNumbersAway,
  showsAwkwardFieldsLegibly,
  keepsTheMeshOutOfTheLegend,
  followsTheField,
  saysWhatIsHidden,
};
