// Ways out of trouble that keep the view.

import assert from 'node:assert/strict';
import {kDesktop, kPhone, kTimeoutMs} from './browser.mjs';
import {expectWhole} from './expect.mjs';
import {differingShare} from './png.mjs';
import {PoorLine} from './poor_line.mjs';

const cameraOf = (viewer) => viewer.page.evaluate(() => window.qtetViewer.cameraState);
const turn = async (viewer) => {
  await viewer.page.locator('qtet-viewer .scene').focus();
  for (const key of ['ArrowLeft', 'ArrowLeft', 'ArrowUp', '+'])
    await viewer.page.keyboard.press(key);
  await viewer.settle();
};
const near = (a, b) => a.every((x, i) => Math.abs(x - b[i]) < 1e-6);

/** A damaged block ends the stream. The second attempt shows the same view, finer. */
async function triesAgainWithTheSameView({server, browser, logs}) {
  const line = await PoorLine.open(server.port, {
    bytesPerSecond: 200000,
    streamsOnly: true,
    damageAt: 150000,
  });
  try {
    const viewer = await browser.open(`${line.url}?mesh=fin&field=Pressure&clip=x:0.4`);
    await viewer.waitForState('failed');
    await viewer.waitForPicture();
    await turn(viewer);
    const camera = await cameraOf(viewer);
    await viewer.page.getByRole('button', {name: 'Try again'}).click();
    await viewer.page.waitForFunction(() => window.qtetViewer.state === 'complete', null, {
      polling: 50,
    });
    await expectWhole(viewer, logs.fin);
    await viewer.settle();
    const after = await cameraOf(viewer);
    assert.ok(near(after, camera), `the camera was at ${camera} and is at ${after}`);
    const {searchParams} = new URL(viewer.page.url());
    assert.deepEqual(
      ['field', 'clip'].map((name) => searchParams.get(name)),
      ['Pressure', 'x:0.4'],
    );
    assert.ok(
      near(await viewer.inView(({cameraState}) => cameraState), camera),
      'the picture has another camera than the page',
    );
  } finally {
    line.close();
  }
}

const drawers = ({page}) => page.workers().filter((worker) => worker.url().includes('view_worker'));

/**
 * The worker that draws ends without a word, then another one hangs. The user sees a message, and
 * gets the same picture from a new worker. That one sees no coarse mesh, whose box may be larger by
 * part of a pixel: so no edges of cells are compared.
 */
async function drawsAnewWhereTheDrawingWorkerEnded({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&clip=y&edges=off`, undefined, () => {
    const kSpeedUp = 10; // speeds up the page's patience
    const {setInterval} = window;
    window.setInterval = (action, ms, ...words) => setInterval(action, ms / kSpeedUp, ...words);
  });
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  await turn(viewer);
  const camera = await cameraOf(viewer);
  const before = await viewer.screenshot('drawing-before');
  const ends = {
    ends: () => void self.close(),
    hangs: () =>
      void setTimeout(() => {
        for (;;);
      }),
  };
  for (const [what, end] of Object.entries(ends)) {
    const old = drawers(viewer);
    await viewer.inView(end);
    await viewer.page.getByText('does not answer').waitFor();
    await viewer.page.getByRole('button', {name: 'Try again'}).click();
    // The browser may report the old worker's end after the new one is there, and that report gets
    // no answer.
    while (drawers(viewer).length !== 1 || old.includes(drawers(viewer)[0]))
      await viewer.page.waitForTimeout(50);
    await viewer.page.waitForFunction(
      () => window.qtetViewer.meshView?.pose.fitted === false,
      null,
      {polling: 50},
    );
    await viewer.settle();
    assert.equal(
      await viewer.page.locator('qtet-viewer .notice').isVisible(),
      false,
      'the notice stays',
    );
    assert.ok(near(await cameraOf(viewer), camera), `${what}: another camera`);
    const differing = differingShare(before, await viewer.screenshot(`drawing-${what}`));
    assert.ok(differing < 0.005, `${what}: ${differing} of the picture is another`);
  }
  // The new canvas receives keys and pointers as the first one did.
  await viewer.page.getByText('Point', {exact: true}).click();
  await viewer.page.mouse.click(560, 400);
  await viewer.page.locator('qtet-viewer .result').waitFor();
  await turn(viewer);
  assert.ok(!near(await cameraOf(viewer), camera), 'keys turn nothing');
  assert.deepEqual(viewer.problems, []);
}

/** The checks' browser draws in software. */
async function saysOnceThatTheGraphicsAreSoftware({server, browser}) {
  for (const [device, isOwnThread] of [
    [kDesktop, false],
    [kPhone, false],
    [kDesktop, true],
  ]) {
    const page = await browser.untold(device);
    page.setDefaultTimeout(kTimeoutMs);
    if (isOwnThread)
      await page.addInitScript(() => delete HTMLCanvasElement.prototype.transferControlToOffscreen);
    await page.goto(`${server.url}?mesh=fin`);
    const note = page.locator('qtet-viewer').getByRole('status').getByText('graphics card');
    await note.waitFor();
    await browser.picture(
      page,
      `software-${device === kPhone ? 'phone' : isOwnThread ? 'own-thread' : 'desktop'}`,
    );
    await page.getByRole('status').getByRole('button', {name: 'Close'}).click();
    await note.waitFor({state: 'detached'});
    const focused = await page.evaluate(() => window.qtetViewer.shadowRoot.activeElement.className);
    assert.equal(focused, 'scene');
    await page.reload();
    await page.waitForFunction(() => window.qtetViewer?.state === 'complete');
    await page.locator('qtet-viewer').getByRole('toolbar', {name: 'Look along an axis'}).waitFor();
    assert.equal(await note.count(), 0, 'it is said twice in a session');
    await page.context().close();
  }
}

export const recoveryChecks = {
  triesAgainWithTheSameView,
  drawsAnewWhereTheDrawingWorkerEnded,
  saysOnceThatTheGraphicsAreSoftware,
};
