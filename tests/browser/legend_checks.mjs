// Fields that are awkward to show: names, numbers and missing values must stay readable.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {kPhone} from './browser.mjs';
import {linearBox} from './volume_checks.mjs';

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

async function showsAwkwardFieldsLegibly({server, browser, logs, out, bin}) {
  const mesh = join(out, 'awkward.vtu');
  writeFileSync(
    mesh,
    linearBox(4, {
      Offset: (x, y, z) => 101325 + 0.03 * z,
      Tiny: (x) => 1e-9 * x,
      Constant: () => 42.5,
      Missing: (x, y, z) => (z < 1 ? NaN : y),
      [kLong]: (x, y) => y,
    }),
  );
  execFileSync(
    join(bin, 'qtet'),
    ['simplify', mesh, '-o', join(logs.fin.folder, 'awkward.qtet'), '--field-bits', '20'],
    {stdio: 'pipe'},
  );
  server.kill();
  await server.start();
  const viewer = await browser.open(`${server.url}?mesh=awkward`, kPhone);
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
  assert.equal(await viewer.inView(({orbit}) => orbit.fitted), true);
  await page.mouse.move(195, 350);
  await page.mouse.down();
  await page.mouse.move(260, 350, {steps: 3});
  await page.mouse.up();
  await viewer.settle();
  assert.equal(await viewer.inView(({orbit}) => orbit.fitted), false);
  assert.deepEqual(viewer.problems, []);
}

/**
 * In a low window, or one at 200 %, the legend is nearly as wide as the free space, so that the
 * mesh must stand above it.
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
    const {bounds} = viewing.mesh;
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

export const legendChecks = {showsAwkwardFieldsLegibly, keepsTheMeshOutOfTheLegend};
