// What the viewer must do in a real browser. Each check gets a running server and throws when the viewer does otherwise.

import assert from 'node:assert/strict';
import {kDesktop, kPhone} from './browser.mjs';
import {coloredShare, differingShare} from './png.mjs';
import {PoorLine} from './poor_line.mjs';

/** Bytes after which the coarse picture is taken: some levels of the samples, never all. */
const kCoarseBytes = 50000;

async function expectWhole(viewer, log) {
  const {tetrahedra, total, bytes, bytesNeeded} = await viewer.statistics();
  assert.equal(tetrahedra, total.tetrahedra);
  assert.equal(bytes, bytesNeeded);
  assert.equal(await viewer.digest(), log.meshDigest);
  assert.deepEqual(viewer.problems, []);
}

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
    notes.push(`${log.name} ${(await viewer.counts()).tetrahedra} cells, first picture after ${Math.round(events[0].at)} ms`);
  }
  return notes.join('; ');
}

async function showsACoarsePictureFirst({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&pauseAfter=${kCoarseBytes}`);
  await viewer.waitForState('paused');
  await viewer.waitForPicture();
  const {tetrahedra, total} = await viewer.statistics();
  assert.ok(tetrahedra > 0 && tetrahedra < total.tetrahedra / 2, `${tetrahedra} of ${total.tetrahedra} cells are not coarse`);
  const coarse = await viewer.screenshot('coarse');
  await viewer.page.getByRole('button', {name: 'Continue'}).click();
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const final = await viewer.screenshot('final');
  for (const [name, picture] of Object.entries({coarse, final})) {
    assert.ok(coloredShare(picture) > 0.05, `the ${name} picture is blank: ${coloredShare(picture)} of it is coloured`);
  }
  const differing = differingShare(coarse, final);
  assert.ok(differing > 0.01, `refining changes only ${differing} of the picture`);
  return `${tetrahedra} of ${total.tetrahedra} cells, ${(100 * differing).toFixed(1)} % of the picture changes`;
}

async function survivesAKilledServer({server, browser, logs}) {
  const line = await PoorLine.open(server.port, {bytesPerSecond: 60000, streamsOnly: true});
  try {
    const viewer = await browser.open(`${line.url}?mesh=fin`);
    await viewer.page.waitForFunction(() => {
      const {chunks, chunkCount} = window.qtetViewer.statistics;
      return chunks > 2 && chunks < chunkCount;
    }, null, {polling: 50});
    server.kill();
    line.cut();
    await viewer.waitForState('reconnecting');
    const before = await viewer.statistics();
    assert.ok(before.chunks < before.chunkCount, 'everything had arrived before the server was killed');
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
  const viewer = await browser.open(`${server.url}?mesh=fin&pauseAfter=${kCoarseBytes}`);
  await viewer.waitForState('paused');
  server.kill();
  await viewer.page.waitForTimeout(300);
  await viewer.page.getByRole('button', {name: 'Continue'}).click();
  await viewer.waitForState('reconnecting');
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
    return `first picture after ${Math.round(events[0].at)} ms at 1.6 Mbit/s and 80 ms, with an empty cache; ${Math.round((100 * bytes) / bytesNeeded)} % is here by now`;
  } finally {
    line.close();
  }
}

async function keepsThePageResponsive({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {longTasks, loadedAt} = await viewer.seen();
  const during = longTasks.filter(({start}) => start > loadedAt).map(({ms}) => Math.round(ms));
  // Software rendering shares this machine's cores with everything else: the bound only catches work that belongs in the worker.
  assert.ok(Math.max(0, ...during) < 400, `the page was blocked for ${Math.max(...during)} ms`);
  return `${during.length} tasks above 50 ms while refining${during.length > 0 ? ` (${during.join(', ')} ms)` : ''}, ${longTasks.length - during.length} before`;
}

async function switchesFieldsAndMaps({server, browser, logs}) {
  const viewer = await browser.open(`${server.url}?mesh=fin`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const before = await viewer.screenshot('field-first');
  const fields = viewer.page.getByLabel('Field');
  const names = await fields.locator('option').evaluateAll((options) => options.map(({value}) => value));
  assert.ok(names.length > 1, 'the sample has one field only');
  await fields.selectOption(names.at(-1));
  await viewer.waitForState('complete');
  await viewer.page.getByRole('radio', {name: 'Cool-warm'}).check({force: true});
  await viewer.page.waitForTimeout(1200);
  assert.ok((await viewer.text('.legend-name')).startsWith(names.at(-1)));
  const differing = differingShare(before, await viewer.screenshot('field-last'));
  assert.ok(differing > 0.05, `another field changes only ${differing} of the picture`);
  await expectWhole(viewer, logs.fin);
  return names.join(', ');
}

async function clipsWithACap({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin`, {...kDesktop, colorScheme: 'dark'});
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const whole = await viewer.screenshot('unclipped');
  await viewer.page.getByRole('switch', {name: 'Clip'}).check();
  await viewer.page.waitForTimeout(1200);
  const clipped = await viewer.screenshot('clipped');
  assert.ok(differingShare(whole, clipped) > 0.02, 'clipping changes nothing');
  const position = viewer.page.getByLabel('Position of the clip plane');
  const text = await viewer.text('.position');
  await position.focus();
  for (let i = 0; i < 100; ++i) await viewer.page.keyboard.press('ArrowRight');
  await viewer.page.waitForTimeout(1200);
  assert.notEqual(await viewer.text('.position'), text);
  assert.ok(differingShare(clipped, await viewer.screenshot('clipped-further')) > 0.005, 'the slider moves nothing');
  await viewer.page.getByRole('switch', {name: 'Clip'}).uncheck();
  await viewer.page.waitForTimeout(1200);
  assert.ok(differingShare(whole, await viewer.screenshot('unclipped-again')) < 0.005, 'the whole mesh does not come back');
}

async function obeysTheKeyboard({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=box`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const before = await viewer.screenshot('keys-before');
  await viewer.page.locator('qtet-viewer canvas').focus();
  for (let i = 0; i < 6; ++i) await viewer.page.keyboard.press('ArrowLeft');
  await viewer.page.waitForTimeout(500);
  assert.ok(differingShare(before, await viewer.screenshot('keys-turned')) > 0.01, 'arrows turn nothing');
  await viewer.page.keyboard.press('Home');
  await viewer.page.waitForTimeout(500);
  assert.ok(differingShare(before, await viewer.screenshot('keys-home')) < 0.005, 'Home does not bring the first view back');
}

async function fitsAPhone({server, browser, logs}) {
  const viewer = await browser.open(`${server.url}`, kPhone);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const picture = await viewer.screenshot('phone');
  assert.ok(coloredShare(picture) > 0.03, 'the phone picture is blank');
  const wide = await viewer.page.evaluate(() => document.documentElement.scrollWidth > document.documentElement.clientWidth);
  assert.equal(wide, false, 'the page scrolls sideways');
  await viewer.page.getByRole('button', {name: 'Controls'}).tap();
  await viewer.page.waitForTimeout(400);
  await viewer.screenshot('phone-controls');
  await viewer.page.locator('qtet-viewer select[name=mesh]').selectOption('fin');
  await viewer.page.waitForFunction(() => window.qtetViewer.state !== 'complete');
  await viewer.waitForState('complete');
  await expectWhole(viewer, logs.fin);
}

async function saysWhatIsWrong({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=nowhere`);
  await viewer.waitForState('failed');
  assert.match(await viewer.page.getByRole('alert').innerText(), /no mesh "nowhere".*box, fin/s);
  const other = await browser.open(`${server.url}?mesh=box&field=nothing`);
  await other.waitForState('complete');
  assert.match(await other.page.getByRole('alert').innerText(), /nothing.*first field/s);
}

export const checks = {
  refinesToTheOriginal, showsACoarsePictureFirst, survivesAKilledServer,
  survivesAServerThatIsAwayWhenItIsAsked, showsAPictureSoonOnAPoorLine,
  keepsThePageResponsive, switchesFieldsAndMaps, clipsWithACap, obeysTheKeyboard, fitsAPhone, saysWhatIsWrong,
};
