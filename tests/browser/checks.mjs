// The checks of the viewer in a real browser. Each check gets a running server and throws if the
// viewer does something else.

import assert from 'node:assert/strict';
import {kDesktop, kPhone} from './browser.mjs';
import {expectWhole} from './expect.mjs';
import {coloredShare, differingShare} from './png.mjs';
import {PoorLine} from './poor_line.mjs';

/** The coarse picture is taken after so many bytes: some levels of the samples, never all. */
const kCoarseBytes = 50000;

async function refinesToTheOriginal({server, browser, logs}) {
  const notes = [];
  for (const log of Object.values(logs)) {
    const viewer = await browser.open(`${server.url}?mesh=${log.name}`);
    await viewer.waitForState('complete');
    await viewer.waitForPicture();
    await expectWhole(viewer, log);
    const {events} = await viewer.seen();
    assert.equal(events[0].type, 'load');
    assert.equal(await viewer.text('.percent'), '100\u202f%');
    notes.push(
      `${log.name} ${(await viewer.counts()).tetrahedra} cells, first picture after ` +
        `${Math.round(events[0].at)} ms`,
    );
  }
  return notes.join('; ');
}

async function showsACoarsePictureFirst({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&quality=bytes:${kCoarseBytes}`);
  await viewer.waitForState('held');
  await viewer.waitForPicture();
  const {tetrahedra, total} = await viewer.statistics();
  assert.ok(
    tetrahedra > 0 && tetrahedra < total.tetrahedra / 2,
    `${tetrahedra} of ${total.tetrahedra} cells are not coarse`,
  );
  const coarse = await viewer.screenshot('coarse');
  await viewer.page.getByRole('button', {name: 'Continue'}).click();
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const final = await viewer.screenshot('final');
  for (const [name, picture] of Object.entries({coarse, final})) {
    assert.ok(
      coloredShare(picture) > 0.05,
      `the ${name} picture is blank: ${coloredShare(picture)} of it is coloured`,
    );
  }
  const differing = differingShare(coarse, final);
  assert.ok(differing > 0.01, `refining changes only ${differing} of the picture`);
  return (
    `${tetrahedra} of ${total.tetrahedra} cells, ${(100 * differing).toFixed(1)} % of the ` +
    'picture changes'
  );
}

async function survivesAKilledServer({server, browser, logs}) {
  const line = await PoorLine.open(server.port, {holdAt: kCoarseBytes});
  try {
    const viewer = await browser.open(`${line.url}?mesh=fin`);
    await viewer.page.waitForFunction(() => window.qtetViewer.statistics.chunks > 2, null, {
      polling: 50,
    });
    server.kill();
    line.cut();
    await viewer.waitForState('reconnecting');
    const before = await viewer.statistics();
    assert.ok(
      before.chunks < before.chunkCount,
      'everything had arrived before the server was killed',
    );
    assert.equal(await viewer.text('.state-text'), 'Reconnecting');
    await server.start();
    await viewer.waitForState('complete');
    await viewer.waitForPicture();
    await expectWhole(viewer, logs.fin);
    return `killed with ${before.chunks} of ${before.chunkCount} chunks applied`;
  } finally {
    line.close();
  }
}

async function survivesAServerThatIsAwayWhenItIsAsked({server, browser, logs}) {
  const viewer = await browser.open(`${server.url}?mesh=fin`);
  await viewer.waitForState('complete');
  server.kill();
  await viewer.page.locator('qtet-viewer select[name=field]').selectOption('Pressure');
  await viewer.waitForState('reconnecting');
  assert.match(await viewer.text('.state-note'), /trying again in \d+/);
  await server.start();
  await viewer.waitForState('complete');
  await expectWhole(viewer, logs.fin);
}

async function showsAPictureSoonOnAPoorLine({server, browser}) {
  const line = await PoorLine.open(server.port, {bytesPerSecond: 200000, delayMs: 40});
  try {
    const viewer = await browser.open(`${line.url}?mesh=fin`);
    await viewer.waitForPicture();
    const {events} = await viewer.seen();
    const {bytes, bytesNeeded} = await viewer.statistics();
    return (
      `first picture after ${Math.round(events[0].at)} ms at 1.6 Mbit/s and 80 ms, with an empty ` +
      `cache; ${Math.round((100 * bytes) / bytesNeeded)} % is here by now`
    );
  } finally {
    line.close();
  }
}

async function keepsThePageResponsive({server, browser}) {
  const trace = await browser.trace();
  const viewer = await browser.open(`${server.url}?mesh=fin`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const tasks = await trace.end();
  const longest = (key) => Math.round(Math.max(...tasks.map((task) => task[key])));
  assert.ok(tasks.length > 50, `only ${tasks.length} tasks were seen`);
  // Measures processor time, because others share the clock. The bound catches only work that
  // belongs in a worker.
  assert.ok(longest('cpuMs') < 200, `the page was busy for ${longest('cpuMs')} ms`);
  return (
    `of ${tasks.length} tasks the longest takes ${longest('cpuMs')} ms of processor time, on the ` +
    `clock ${longest('ms')} ms`
  );
}

async function switchesFieldsAndMaps({server, browser, logs}) {
  const viewer = await browser.open(`${server.url}?mesh=fin`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  let before = await viewer.screenshot('field-first');
  const fields = viewer.page.locator('qtet-viewer select[name=field]');
  await fields.locator('option').nth(8).waitFor({state: 'attached'});
  const names = await fields
    .locator('option')
    .evaluateAll((options) => options.map(({value}) => value));
  assert.deepEqual(names, [
    'Density',
    'Pressure',
    'Velocity',
    'Velocity.x',
    'Velocity.y',
    'Velocity.z',
    'Velocity.div',
    'Velocity.vorticity',
    'Velocity.Q',
  ]);
  const expectChange = async (name, what) => {
    await viewer.settle();
    const now = await viewer.screenshot(name);
    assert.ok(
      differingShare(before, now) > 0.05,
      `${what} changes only ${differingShare(before, now)} of the picture`,
    );
    before = now;
  };
  await fields.selectOption('Velocity.z');
  await viewer.waitForState('complete');
  await viewer.page.getByRole('radio', {name: 'Cool-warm'}).check({force: true});
  await expectChange('field-last', 'another field');
  assert.equal(await viewer.text('.legend-name'), 'Velocity, z');
  await viewer.page.getByLabel('Reversed').check({force: true});
  await expectChange('map-reversed', 'the reversed map');
  await viewer.page.getByLabel('Range of the colours').selectOption('symmetric');
  await viewer.settle();
  const ticks = await viewer.page.locator('qtet-viewer .legend-ticks span').allInnerTexts();
  assert.equal(ticks[0].replace('\u2212', ''), ticks.at(-1), `not symmetric: ${ticks}`);
  await viewer.page.getByRole('radio', {name: 'Turbo'}).check({force: true});
  await expectChange('map-turbo', 'turbo');
  await fields.selectOption('Pressure');
  await viewer.waitForState('complete');
  await viewer.page.getByLabel('Range of the colours').selectOption('fixed');
  await viewer.page.getByLabel('Start of the range').fill('0.5');
  await viewer.page.getByLabel('End of the range').fill('2');
  await viewer.page.keyboard.press('Enter');
  await viewer.page.getByLabel('Log scale').check({force: true});
  await expectChange('range-fixed-log', 'a fixed logarithmic range');
  assert.equal(await viewer.text('.legend-factor'), 'logarithmic');
  await expectWhole(viewer, logs.fin);
}

async function clipsWithACap({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin`, {...kDesktop, colorScheme: 'dark'});
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  assert.ok(await page.getByRole('switch', {name: 'Clip'}).isChecked(), 'the fin opens whole');
  await page.getByRole('switch', {name: 'Clip'}).uncheck();
  await viewer.settle();
  assert.equal(new URL(page.url()).searchParams.get('clip'), 'none');
  const whole = await viewer.screenshot('unclipped');
  await page.getByRole('switch', {name: 'Clip'}).check();
  await viewer.settle();
  const clipped = await viewer.screenshot('clipped');
  assert.ok(differingShare(whole, clipped) > 0.02, 'clipping changes nothing');
  const text = await viewer.text('.plane:first-child .position');
  await page.getByLabel('Position of clip plane 1').focus();
  for (let i = 0; i < 100; ++i) await page.keyboard.press('ArrowRight');
  await viewer.settle();
  assert.notEqual(await viewer.text('.plane:first-child .position'), text);
  const further = await viewer.screenshot('clipped-further');
  assert.ok(differingShare(clipped, further) > 0.005, 'the slider moves nothing');
  const {x, y, width} = await page.locator('qtet-viewer .handle').first().boundingBox();
  await page.mouse.move(x + width / 2, y + width / 2);
  await page.mouse.down();
  await page.mouse.move(x - 80, y, {steps: 4});
  await page.mouse.up();
  await viewer.settle();
  assert.ok(
    differingShare(further, await viewer.screenshot('clip-dragged')) > 0.005,
    'the handle moves nothing',
  );
  let before = await viewer.screenshot('clip-flat');
  for (const mode of ['Cells', 'Slice']) {
    await page.getByRole('radio', {name: mode}).check({force: true});
    await viewer.settle();
    const now = await viewer.screenshot(`clip-${mode.toLowerCase()}`);
    assert.ok(differingShare(before, now) > 0.005, `${mode} looks like what was before`);
    before = now;
  }
  await page.getByRole('button', {name: 'Add a plane'}).click();
  await viewer.settle();
  assert.ok(
    differingShare(before, await viewer.screenshot('clip-two')) > 0.005,
    'the second plane shows nothing',
  );
  await page.getByRole('switch', {name: 'Clip'}).uncheck();
  await viewer.settle();
  assert.ok(
    differingShare(whole, await viewer.screenshot('unclipped-again')) < 0.005,
    'the whole mesh does not come back',
  );
}

async function showsIsosurfacesAndThresholds({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const whole = await viewer.screenshot('solid');
  const {page} = viewer;
  await page.getByRole('switch', {name: 'Threshold'}).check();
  await viewer.settle();
  const within = await viewer.screenshot('threshold');
  assert.ok(differingShare(whole, within) > 0.05, 'the threshold hides nothing');
  await page.getByRole('switch', {name: 'Threshold'}).uncheck();
  await page.getByRole('switch', {name: 'Isosurfaces'}).check();
  await page.getByLabel('Field of the isosurfaces').selectOption('Pressure');
  await viewer.waitForState('complete');
  await page.getByRole('textbox', {name: 'Values', exact: true}).fill('1, 2.5');
  await page.keyboard.press('Enter');
  await page.getByLabel('Opacity').fill('20');
  await viewer.settle();
  const inside = await viewer.screenshot('isosurfaces');
  assert.ok(differingShare(whole, inside) > 0.05, 'nothing shines through');
  await page.getByRole('switch', {name: 'Surface', exact: true}).uncheck();
  await viewer.settle();
  assert.ok(
    coloredShare(await viewer.screenshot('isosurfaces-alone')) > 0.005,
    'there are no isosurfaces',
  );
  assert.equal(new URL(page.url()).searchParams.get('iso'), 'Pressure=1,2.5');
  await page.locator('qtet-viewer select[name=field]').selectOption('Pressure');
  await page.evaluate(() => window.qtetViewer.setAttribute('range', 'full'));
  await viewer.waitForState('complete');
  await viewer.settle();
  const marks = page.locator('qtet-viewer .legend-bar i');
  const [first, second] = await marks.evaluateAll((all) => all.map((it) => it.style.left));
  assert.ok(parseFloat(first) < parseFloat(second), `marks at ${first} and ${second}`);
  assert.deepEqual(viewer.problems, []);
}

async function pointsAndProbes({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&field=Density&clip=y:0.5`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  await page.getByText('Point', {exact: true}).click();
  await page.mouse.click(560, 400);
  await page.locator('qtet-viewer .result').waitFor();
  const said = await viewer.text('.result');
  const [, density, cell] = /Density\s+([\d.]+).*Cell\s*([\d\u202f]+)/s.exec(said) ?? [];
  assert.ok(
    Number(cell?.replaceAll('\u202f', '')) < 212544 && Number(density) > 0.5 && Number(density) < 4,
    said,
  );
  await page.getByText('Line', {exact: true}).click();
  await page.mouse.click(520, 420); // beside the handle of the plane
  await page.locator('qtet-viewer .tool-hint', {hasText: 'Now point at the other end.'}).waitFor();
  await page.mouse.click(700, 400);
  await page.locator('qtet-viewer .plot canvas').waitFor();
  await page.mouse.move(700, 700);
  assert.match(await viewer.text('.result'), /Distance\s+[\d.]+/);
  const drawn = await page.evaluate(() => {
    const canvas = window.qtetViewer.shadowRoot.querySelector('.plot canvas');
    return canvas
      .getContext('2d')
      .getImageData(0, 0, canvas.width, canvas.height)
      .data.filter((value, i) => i % 4 === 3 && value > 0).length;
  });
  assert.ok(drawn > 500, `the plot has ${drawn} pixels`);
  await viewer.screenshot('probe');
  assert.deepEqual(viewer.problems, []);
  return said.replaceAll('\n', ' ');
}

/** Cards open over the picture. They leave the camera, the fit and the point alone. */
async function cardsNeverMoveTheMesh({server, browser}, device, name) {
  const viewer = await browser.open(`${server.url}?mesh=fin&clip=none`, device);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  const bare = async (shot) => {
    await viewer.settle();
    const style = await page.addStyleTag({
      content:
        'qtet-viewer::part(panel), qtet-viewer::part(legend), qtet-viewer::part(hint), ' +
        'qtet-viewer::part(marks), qtet-viewer::part(result) { display: none }',
    });
    const picture = await viewer.screenshot(shot);
    await style.evaluate((its) => its.remove());
    return picture;
  };
  const tool = (its) =>
    page.evaluate(
      (value) => window.qtetViewer.shadowRoot.querySelector(`.tools input[value=${value}]`).click(),
      its,
    );
  const before = await bare(`${name}-before`);
  await tool('point');
  assert.equal(await viewer.text('.tool-hint'), 'Point at a place on the mesh.');
  const [x, y] = await page.evaluate(() => {
    const {meshView, viewing} = window.qtetViewer;
    const {bounds} = viewing.mesh.base;
    const at = meshView.project([0, 1, 2].map((axis) => (bounds[axis] + bounds[axis + 3]) / 2));
    return [at.x, at.y];
  });
  await page.mouse.click(x, y);
  await page.locator('qtet-viewer .result').waitFor();
  await viewer.screenshot(`${name}-point`);
  const mark = await page.evaluate(() => {
    const circle = window.qtetViewer.shadowRoot.querySelector('.marks circle');
    return ['cx', 'cy'].map((axis) => Number(circle.getAttribute(axis)));
  });
  assert.ok(Math.hypot(mark[0] - x, mark[1] - y) < 1, `clicked ${[x, y]}, marked ${mark}`);
  assert.equal(differingShare(before, await bare(`${name}-point-bare`)), 0);
  await page.locator('qtet-viewer .fold').click();
  const folded = await bare(`${name}-folded`);
  // an open sheet lifts the mesh on a phone
  if (device !== kPhone) assert.equal(differingShare(before, folded), 0);
  await page.locator('qtet-viewer .fold').click();
  assert.equal(differingShare(before, await bare(`${name}-unfolded`)), 0);

  const title = page.locator('qtet-viewer .result h2');
  const box = async () => page.locator('qtet-viewer .result').boundingBox();
  const from = await box();
  const hold = await title.boundingBox();
  await page.mouse.move(hold.x + 9, hold.y + 9);
  await page.mouse.down();
  await page.mouse.move(hold.x + 9, hold.y + 9 + (from.y > 100 ? -60 : 60), {steps: 3});
  await page.mouse.up();
  assert.equal(Math.abs((await box()).y - from.y), 60, 'the card cannot be dragged');

  await tool('line');
  await page.mouse.click(x - 30, y);
  await page.locator('qtet-viewer .tool-hint', {hasText: 'Now point at the other end.'}).waitFor();
  await page.mouse.click(x + 30, y);
  await page.locator('qtet-viewer .plot canvas').waitFor();
  await viewer.screenshot(`${name}-line`);
  assert.equal(differingShare(before, await bare(`${name}-line-bare`)), 0);
  await tool('none');
  assert.equal(differingShare(before, await bare(`${name}-closed`)), 0);
  assert.deepEqual(viewer.problems, []);
}

const cardsMoveNothing = (context) => cardsNeverMoveTheMesh(context, kDesktop, 'cards');
const cardsMoveNothingOnAPhone = (context) => cardsNeverMoveTheMesh(context, kPhone, 'cards-phone');

async function goesCoarserAndStopsAtAnError({server, browser, logs}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&quality=1%`);
  await viewer.waitForState('held');
  await viewer.waitForPicture();
  const {tetrahedra, total} = await viewer.statistics();
  assert.ok(tetrahedra < total.tetrahedra / 5, `1 % takes ${tetrahedra} cells`);
  const left = Number.parseFloat(await viewer.text('.error-left'));
  assert.ok(left > 0 && left <= 1, `the error that is left is ${left} %`);
  const exact = await viewer.page.locator('.error-left').getAttribute('title');
  assert.match(
    exact,
    /^Velocity is at most [\d.]+ off now, as sampled, and within [\d.]+ at the last level$/,
  );
  await viewer.page.getByText('Level of detail').click();
  await viewer.page.getByRole('button', {name: 'Coarser'}).click();
  await viewer.page.waitForFunction(
    (before) => window.qtetViewer.statistics.tetrahedra < before,
    tetrahedra,
  );
  await viewer.settle();
  await viewer.screenshot('coarser');
  await viewer.page.getByRole('button', {name: 'Continue'}).click();
  await viewer.waitForState('complete');
  await expectWhole(viewer, logs.fin);
  return `1 % of error with ${tetrahedra} of ${total.tetrahedra} cells`;
}

async function showsTheSamePictureFromItsLink({server, browser}) {
  const viewer = await browser.open(
    `${server.url}?mesh=fin&clip=x:0.4 -z:0.6&field=Pressure&colormap=cividis`,
  );
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  await viewer.page.locator('qtet-viewer .scene').focus();
  for (const key of ['ArrowLeft', 'ArrowLeft', 'ArrowUp', '+', 'o'])
    await viewer.page.keyboard.press(key);
  await viewer.settle();
  const first = await viewer.screenshot('link-from');
  // A link's camera is relative to the whole mesh, which spans its lattice of 16 bits, not to the
  // coarse mesh that came first.
  assert.equal(await viewer.inView(({camera: {bounds}}) => bounds[3] - bounds[0]), 65535);
  const again = await browser.open(viewer.page.url());
  await again.waitForState('complete');
  await again.waitForPicture();
  await again.settle();
  const differing = differingShare(first, await again.screenshot('link-to'));
  assert.ok(differing < 0.005, `${differing} of the picture is another`);
  await viewer.page.locator('qtet-viewer summary', {hasText: 'View'}).click();
  await viewer.page.getByRole('button', {name: 'Share'}).click();
  assert.equal(
    await viewer.page.getByLabel('Link to this picture').inputValue(),
    viewer.page.url(),
  );
  assert.match(
    await viewer.page.getByLabel('Lines for another page').inputValue(),
    /<iframe src="http.*clip=x%3A0.4\+-z%3A0.6/s,
  );
}

async function comesBackFromLostGraphics({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&clip=y`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const before = await viewer.screenshot('graphics-before');
  await viewer.inView(({scene: {graphics}}) => {
    globalThis.qtetLoss = graphics.gl.getExtension('WEBGL_lose_context');
    globalThis.qtetLoss.loseContext();
  });
  await viewer.page.getByText('The browser took the graphics away').waitFor();
  await viewer.inView(() => globalThis.qtetLoss.restoreContext());
  await viewer.page.locator('qtet-viewer .notice').waitFor({state: 'hidden'});
  await viewer.settle();
  assert.ok(
    differingShare(before, await viewer.screenshot('graphics-after')) < 0.005,
    'the picture does not come back',
  );
}

/**
 * In older browsers no worker can draw into a canvas. The page draws itself, with the same script.
 */
async function drawsWithoutAWorker({server, browser}) {
  const viewer = await browser.open(
    `${server.url}?mesh=fin&clip=y`,
    kDesktop,
    () => delete HTMLCanvasElement.prototype.transferControlToOffscreen,
  );
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const before = await viewer.screenshot('own-thread');
  assert.ok(coloredShare(before) > 0.05, 'nothing is shown');
  const workers = viewer.page.workers().filter((its) => !its.url().includes('start_graphics'));
  assert.equal(workers.length, 1);
  await viewer.page.mouse.move(500, 400);
  await viewer.page.mouse.down();
  await viewer.page.mouse.move(650, 380, {steps: 4});
  await viewer.page.mouse.up();
  await viewer.settle();
  const turned = await viewer.screenshot('own-thread-turned');
  assert.ok(differingShare(before, turned) > 0.05, 'dragging turns nothing');
  // The worker's way to the same picture.
  const again = await browser.open(viewer.page.url());
  await again.waitForState('complete');
  await again.waitForPicture();
  await again.settle();
  const differing = differingShare(turned, await again.screenshot('worker-turned'));
  assert.ok(differing < 0.005, `${differing} of the picture is another than the worker's`);
  assert.deepEqual(viewer.problems, []);
}

/**
 * Left button, right button, wheel: each moves the camera that the worker has, and the page knows
 * of it.
 */
async function turnsByPointer({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=box`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {page} = viewer;
  const camera = () => page.evaluate(() => window.qtetViewer.cameraState);
  let before = await camera();
  const expectMoved = async (what, same, other) => {
    await viewer.settle();
    const now = await camera();
    const moved = (from, to) =>
      Math.hypot(...[0, 1, 2].map((i) => now[from + i] - before[to + i])) > 1e-3;
    assert.equal(
      moved(3, 3),
      other,
      `${what}: the target is at ${now.slice(3)} after ${before.slice(3)}`,
    );
    assert.equal(
      Math.abs(Math.hypot(...now.slice(0, 3)) - Math.hypot(...before.slice(0, 3))) < 1e-2,
      same,
      `${what}: the distance`,
    );
    assert.notDeepEqual(now, before, what);
    before = now;
  };
  const drag = async (button) => {
    await page.mouse.move(500, 400);
    await page.mouse.down({button});
    await page.mouse.move(620, 430, {steps: 4});
    await page.mouse.up({button});
  };
  await drag('left');
  await expectMoved('turned', true, false);
  await drag('right');
  await expectMoved('shifted', true, true);
  await page.mouse.move(300, 300);
  await page.mouse.wheel(0, -400);
  await expectMoved('nearer', false, true);
  await page.mouse.move(700, 500);
  await page.waitForTimeout(300);
  assert.deepEqual(await camera(), before, 'a move without a button turns');
}

async function isAccessible({server, browser}) {
  const notes = [];
  for (const colorScheme of ['light', 'dark']) {
    const viewer = await browser.open(
      `${server.url}?mesh=fin&clip=x&iso=Density=2&threshold=Density=1,4&volume=0,0.1,0.4`,
      {...kDesktop, colorScheme},
    );
    await viewer.waitForState('complete');
    await viewer.waitForPicture();
    notes.push(await viewer.page.locator('qtet-viewer .live').innerText());
    for (const summary of await viewer.page.locator('qtet-viewer summary:visible').all())
      if (!(await summary.evaluate(({parentElement}) => parentElement.open))) await summary.click();
    const expectNone = async (what) =>
      assert.deepEqual(await viewer.accessibilityViolations(), [], `${colorScheme}, ${what}`);
    await expectNone('every panel open');
    await viewer.page.evaluate(() =>
      ['volume', 'clip', 'iso', 'threshold'].forEach((name) =>
        window.qtetViewer.removeAttribute(name),
      ),
    );
    await viewer.page.getByText('Line', {exact: true}).click();
    for (const x of [420, 640]) {
      await viewer.settle();
      await viewer.page.mouse.click(x, 400);
    }
    await viewer.page.locator('qtet-viewer .plot canvas').waitFor();
    await expectNone('a line with its plot');
    for (const [button, dialog] of [
      ['Share', '.share-dialog'],
      ['Keys', '.help-dialog'],
    ]) {
      await viewer.page.getByRole('button', {name: button}).click();
      await viewer.page.locator(`qtet-viewer ${dialog}[open]`).waitFor();
      await expectNone(button);
      await viewer.page.keyboard.press('Escape');
    }
    await viewer.page.locator('qtet-viewer .close-result').click();
    // The focus goes through the panel from top to bottom.
    await viewer.page.locator('qtet-viewer .scene').focus();
    await viewer.page.keyboard.press('Tab');
    assert.equal(
      await viewer.page.evaluate(() => window.qtetViewer.shadowRoot.activeElement.name),
      'mesh',
    );
    await browser.closePages();
  }
  assert.deepEqual(notes, ['Complete', 'Complete']);
}

async function obeysTheKeyboard({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=box`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const before = await viewer.screenshot('keys-before');
  await viewer.page.locator('qtet-viewer .scene').focus();
  for (let i = 0; i < 6; ++i) await viewer.page.keyboard.press('ArrowLeft');
  await viewer.settle();
  assert.ok(
    differingShare(before, await viewer.screenshot('keys-turned')) > 0.01,
    'arrows turn nothing',
  );
  await viewer.page.keyboard.press('Home');
  await viewer.settle();
  assert.ok(
    differingShare(before, await viewer.screenshot('keys-home')) < 0.005,
    'Home does not bring the first view back',
  );
  // The middle is that of the free part of the picture. A view that was turned is not fitted again
  // beside the card.
  await viewer.page.keyboard.press('ArrowLeft');
  await viewer.settle();
  await viewer.page.keyboard.press('i');
  await viewer.page.locator('qtet-viewer .result').waitFor();
  await viewer.settle();
  const off = await viewer.page.evaluate(() => {
    const {meshView, viewing, shadowRoot} = window.qtetViewer;
    const {clientWidth, clientHeight} = meshView.canvas;
    const [x, y] = viewing.controls.shell.cards.middle;
    const mark = shadowRoot.querySelector('.marks circle');
    return Math.hypot(
      mark.getAttribute('cx') - x * clientWidth,
      mark.getAttribute('cy') - y * clientHeight,
    );
  });
  assert.ok(off < 2, `the middle is ${off} pixels off`);
}

async function fitsAPhone({server, browser, logs}) {
  const viewer = await browser.open(`${server.url}`, kPhone);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const picture = await viewer.screenshot('phone');
  assert.ok(coloredShare(picture) > 0.03, 'the phone picture is blank');
  const wide = await viewer.page.evaluate(
    () => document.documentElement.scrollWidth > document.documentElement.clientWidth,
  );
  assert.equal(wide, false, 'the page scrolls sideways');
  await viewer.page.getByRole('button', {name: 'Controls'}).tap();
  await viewer.settle();
  await viewer.screenshot('phone-controls');
  await viewer.page.locator('qtet-viewer select[name=mesh]').selectOption('fin');
  await viewer.waitForState('complete');
  await expectWhole(viewer, logs.fin);
}

async function showsWhatIsSoundOfADamagedFile({server, browser, logs}) {
  const line = await PoorLine.open(server.port, {
    bytesPerSecond: 200000,
    streamsOnly: true,
    damageAt: 150000,
  });
  try {
    const viewer = await browser.open(`${line.url}?mesh=fin`);
    await viewer.waitForState('failed');
    const said = await viewer.page.getByRole('alert').innerText();
    assert.match(
      said,
      /chunk \d+, part \d+ arrived damaged.*What came before is sound and stays on the screen/s,
    );
    await viewer.waitForPicture();
    await viewer.settle();
    const {tetrahedra, total} = await viewer.statistics();
    assert.ok(tetrahedra > 10000 && tetrahedra < total.tetrahedra, `${tetrahedra} cells are shown`);
    assert.ok(coloredShare(await viewer.screenshot('damaged')) > 0.05, 'nothing is shown');
    await viewer.page.getByRole('button', {name: 'Try again'}).click();
    await viewer.page.waitForFunction(() => window.qtetViewer.state === 'complete', null, {
      polling: 50,
    });
    await expectWhole(viewer, logs.fin);
    return said.split('\n')[0];
  } finally {
    line.close();
  }
}

async function saysWhatIsWrong({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=nowhere`);
  await viewer.waitForState('failed');
  assert.match(await viewer.page.getByRole('alert').innerText(), /no mesh "nowhere".*box, fin/s);
  await viewer.page.locator('qtet-viewer select[name=mesh]').selectOption('box');
  await viewer.waitForState('complete');
  assert.equal(await viewer.page.getByRole('alert').count(), 0, 'the notice stays');
  const other = await browser.open(`${server.url}?mesh=box&field=nothing`);
  await other.waitForState('complete');
  assert.match(await other.page.getByRole('alert').innerText(), /nothing.*first field/s);
}

export const checks = {
  refinesToTheOriginal,
  showsACoarsePictureFirst,
  survivesAKilledServer,
  survivesAServerThatIsAwayWhenItIsAsked,
  showsAPictureSoonOnAPoorLine,
  keepsThePageResponsive,
  switchesFieldsAndMaps,
  clipsWithACap,
  showsIsosurfacesAndThresholds,
  pointsAndProbes,
  cardsMoveNothing,
  cardsMoveNothingOnAPhone,
  goesCoarserAndStopsAtAnError,
  showsTheSamePictureFromItsLink,
  comesBackFromLostGraphics,
  drawsWithoutAWorker,
  turnsByPointer,
  isAccessible,
  obeysTheKeyboard,
  fitsAPhone,
  showsWhatIsSoundOfADamagedFile,
  saysWhatIsWrong,
};
