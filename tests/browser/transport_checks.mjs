// The transports of a log, each by itself and one after the other.

import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {kDesktop, kTimeoutMs} from './browser.mjs';
import {expectWhole} from './expect.mjs';
import {coloredShare} from './png.mjs';
import {PoorLine} from './poor_line.mjs';
import {makeLog, Server} from './programs.mjs';
import {hostFolder, makeSite} from './static_host.mjs';
import {kStrictPolicy} from './strict_policy.mjs';

async function readsALogFromAPlainWebServer({browser, logs, viewer: files, out}) {
  const folder = makeSite(join(out, 'site'), files, logs.fin);
  const notes = [];
  for (const options of [{}, {nginx: false}, {ranges: false}]) {
    const host = await hostFolder(folder, options);
    try {
      const viewer = await browser.open(`${host.url}?src=fin.qtet&colormap=cividis`, {
        ...kDesktop,
        colorScheme: notes.length === 0 ? 'dark' : 'light',
      });
      await viewer.waitForState('complete');
      await viewer.waitForPicture();
      await expectWhole(viewer, logs.fin);
      assert.equal(await viewer.text('.mesh-name'), 'fin');
      await viewer.page.locator('qtet-viewer select[name=field]').selectOption('Pressure');
      await viewer.waitForState('complete');
      await expectWhole(viewer, logs.fin);
      assert.match(viewer.page.url(), /src=fin\.qtet/);
      if (notes.length === 0) await viewer.screenshot('static-host');
      const fetched = host.requests.filter((line) => line.startsWith('/fin.qtet'));
      if (options.ranges === false) assert.equal(fetched.length, 1);
      notes.push(`${host.name}${fetched.length > 0 ? ` ${fetched.length} requests` : ''}`);
    } finally {
      host.close();
    }
  }
  return notes.join(', ');
}

async function saysThatAFileIsMissing({browser, logs, viewer: files, out}) {
  const host = await hostFolder(makeSite(join(out, 'site'), files, logs.box), {nginx: false});
  try {
    const missing = await browser.open(`${host.url}?src=nowhere.qtet`);
    await missing.waitForState('failed');
    assert.match(await missing.page.getByRole('alert').innerText(), /nowhere\.qtet.*404/);
    const none = await browser.open(host.url);
    await none.waitForState('failed');
    assert.match(await none.page.getByRole('alert').innerText(), /src=FILE\.qtet/);
  } finally {
    host.close();
  }
}

async function readsAFileOnlySoFar({browser, logs, viewer: files, out}) {
  const host = await hostFolder(makeSite(join(out, 'site'), files, logs.fin), {nginx: false});
  try {
    const viewer = await browser.open(`${host.url}?src=fin.qtet&quality=cells:20000`);
    await viewer.waitForState('held');
    const {tetrahedra} = await viewer.statistics();
    assert.ok(tetrahedra > 2000 && tetrahedra < 50000, `${tetrahedra} cells`); // whole chunks
  } finally {
    host.close();
  }
}

async function takesRangesAndChunksFromAServer({server, browser, logs}) {
  for (const kind of ['range', 'chunks']) {
    const viewer = await browser.open(`${server.url}?mesh=fin&transport=${kind}`);
    await viewer.waitForState('complete');
    await expectWhole(viewer, logs.fin);
    const fetched = await viewer.page.evaluate(() =>
      performance.getEntriesByType('resource').map(({name}) => name),
    );
    assert.ok(!fetched.some((name) => name.includes('/v1/stream')), 'a WebSocket was opened');
  }
}

async function goesOnOverHttpWhereTheSocketIsBlocked({server, browser, logs}) {
  const line = await PoorLine.open(server.port, {holdAt: 50000});
  try {
    const viewer = await browser.open(`${line.url}?mesh=fin`);
    await viewer.page.waitForFunction(() => window.qtetViewer.statistics.chunks > 2, null, {
      polling: 50,
    });
    const {chunks, chunkCount} = await viewer.statistics();
    assert.ok(chunks < chunkCount, 'everything had come before the line was cut');
    line.refuseStreams = true;
    line.cut();
    await viewer.waitForState('complete');
    await expectWhole(viewer, logs.fin);
    return `with ${chunks} of ${chunkCount} chunks by WebSocket`;
  } finally {
    line.close();
  }
}

/** The curve shows the log's errors to the end, where only rounding is left, and the part here. */
async function showsWhichPartOfTheCurveIsHere({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&quality=cells:20000`);
  await viewer.waitForState('held');
  await viewer.page.getByText('Level of detail').click();
  assert.match(
    await viewer.text('.curve figcaption'),
    /^Error against bytes: [\d.]+\u202f% at .*, [\d.]+\u202f% at .*, 0\.00\d\u202f% at /,
  );
  const [ahead, reached] = await viewer.page
    .locator('qtet-viewer .curve path')
    .evaluateAll((paths) => paths.map((path) => path.getAttribute('d').split('L').length));
  assert.ok(reached > 2 && reached < ahead, `${reached} of ${ahead} points are reached`);
}

/** Plots the middle over time. Returns what the card says of the values, and their table. */
async function plotOverTime(viewer) {
  const {page} = viewer;
  await page.locator('qtet-viewer canvas.scene').focus();
  await page.keyboard.press('i');
  await page.getByRole('button', {name: 'Over time'}).click();
  const status = page.locator('qtet-viewer .result .status');
  await status.getByText(/exact|9 of 9/).waitFor();
  const download = page.waitForEvent('download');
  await page.getByRole('button', {name: 'Save as CSV'}).click();
  const rows = readFileSync(await (await download).path(), 'utf8').split('\r\n');
  const text = await status.innerText();
  await page.locator('qtet-viewer .close-result').click();
  return {status: text, table: rows.map((row) => row.split(','))};
}

/**
 * A series is one field with a time. Its instants come alone and play; what is shown stays whole.
 */
async function playsASeries({server, browser, out, bin}) {
  makeLog(
    bin,
    'series',
    out,
    ['fin', '--steps', '9'],
    ['--fields', 'Density', '--measure', 'none'],
  );
  server.kill();
  await server.start();
  const viewer = await browser.open(`${server.url}?mesh=series&time=3`);
  await viewer.waitForState('complete');
  await viewer.settle();
  const shown = () =>
    viewer.page.evaluate(() => {
      const {mesh} = window.qtetViewer.viewing;
      const {instant} = mesh.manifest.fields[mesh.snapshot.color.field];
      return instant.time;
    });
  assert.equal(await shown(), 3);
  assert.equal(await viewer.page.locator('qtet-viewer input[name=instant]').inputValue(), '3');
  const options = await viewer.page
    .locator('qtet-viewer select[name=field] option')
    .allInnerTexts();
  assert.deepEqual(options, ['Density']);
  const few = (await viewer.statistics()).bytes;
  const here = () =>
    viewer.page.evaluate(() => window.qtetViewer.viewing.mesh.progress.here.length);
  const hereBefore = await here();
  const fromServer = await plotOverTime(viewer);
  assert.match(fromServer.status, /^\d+\sB from the server, exact, level (\d+) of \1\.$/);
  assert.equal(await here(), hereBefore, "instants are fetched beside the server's answer");
  await viewer.screenshot('over-time');
  await viewer.page.locator('qtet-viewer canvas.scene').focus();
  await viewer.page.keyboard.press('.');
  await viewer.page.waitForFunction(
    () => {
      const {mesh} = window.qtetViewer.viewing;
      return mesh.manifest.fields[mesh.snapshot.color.field].instant.time === 4;
    },
    null,
    {polling: 50},
  );
  await viewer.screenshot('series');
  await viewer.page.keyboard.press('Space');
  const seen = new Set();
  for (const end = Date.now() + kTimeoutMs; seen.size < 9; seen.add(await shown())) {
    assert.ok(Date.now() < end, `only ${[...seen]} were shown`);
    await viewer.page.waitForTimeout(30);
  }
  await viewer.page.keyboard.press('Space');
  await viewer.waitForState('complete');
  assert.equal(await here(), 9);

  await viewer.page.route(/series\?/, (route) => route.fulfill({status: 503}));
  const fromBlocks = await plotOverTime(viewer);
  assert.match(fromBlocks.status, /^9 of 9 instants are here, /);
  assert.equal(fromServer.table.length, 10);
  fromServer.table.forEach(([time, value], i) => {
    const [itsTime, itsValue] = fromBlocks.table[i];
    assert.equal(itsTime, time);
    if (i > 0) assert.ok(Math.abs(itsValue - value) < 1e-4, `${itsValue} is not ${value}`);
  });
  return `one instant with ${few} bytes, then all nine`;
}

/** Guarded meshes: the page says so, and shows them once it has the token, with every transport. */
async function showsWhatATokenOpens({browser, logs, viewer: files, out, bin}) {
  const token = 'mq3Vt0pCk8Jx1yQ2b7nS5uEw';
  writeFileSync(join(out, 'tokens'), `read fin ${token}\n`);
  const guarded = new Server(bin, logs.fin.folder, files, ['--tokens', join(out, 'tokens')]);
  await guarded.start();
  try {
    for (const transport of ['websocket', 'range', 'chunks']) {
      const viewer = await browser.open(`${guarded.url}?mesh=fin&transport=${transport}`);
      await viewer.waitForState('failed');
      assert.match(await viewer.page.getByRole('alert').innerText(), /token/);
      await viewer.page.evaluate((text) => void (window.qtetViewer.token = text), token);
      await viewer.waitForState('complete');
      await expectWhole(viewer, logs.fin);
    }
  } finally {
    guarded.kill();
  }
}

/** Each fault ends with a sentence that says what and where, not with waiting. */
async function namesEachFault({server, browser, logs, viewer: files, out}) {
  const wrong = 'clip=w:0.5&range=5,1&quality=best&field=Nope&iso=Nope=1&colormap=rainbow';
  const viewer = await browser.open(`${server.url}?mesh=fin&${wrong}`);
  await viewer.waitForState('complete');
  const said = () => viewer.text('.notice p');
  for (const [name, text] of new URLSearchParams(wrong))
    assert.ok((await said()).includes(`"${text}"`), `${name}: ${await said()}`);
  await viewer.page.evaluate(
    (names) => {
      for (const name of names) window.qtetViewer.removeAttribute(name);
    },
    [...new URLSearchParams(wrong).keys()],
  );
  await viewer.settle();
  assert.ok(await viewer.page.locator('qtet-viewer .notice').isHidden(), 'the notice stays');
  await viewer.page.evaluate(() => window.qtetViewer.setAttribute('field', 'Later'));
  await viewer.page.getByText('The mesh has no field "Later"').waitFor();

  const folder = makeSite(join(out, 'empty-site'), files, logs.box);
  writeFileSync(join(folder, 'empty.qtet'), '');
  for (const ranges of [true, false]) {
    const host = await hostFolder(folder, {ranges, nginx: false});
    try {
      const empty = await browser.open(`${host.url}?src=empty.qtet`);
      await empty.waitForState('failed');
      assert.match(await empty.text('.notice p'), /empty\.qtet is empty: it has 0 bytes/);
      const other = await browser.open(`${server.url}?src=${host.url}box.qtet`);
      await other.waitForState('failed');
      assert.match(await other.text('.notice p'), /Access-Control-Allow-Origin/);
    } finally {
      host.close();
    }
  }
}

async function worksUnderAStrictPolicy({browser, logs, viewer: files, out}) {
  const folder = makeSite(join(out, 'strict-site'), files, logs.fin);
  const headers = {'content-security-policy': kStrictPolicy};
  const host = await hostFolder(folder, {nginx: false, headers});
  const messages = [];
  try {
    const url = `${host.url}?src=fin.qtet&clip=x:0.5`;
    const page = await browser.page(url, (text) => messages.push(text));
    const isThere = () =>
      page.evaluate(
        () =>
          window.qtetViewer?.state === 'complete' &&
          window.qtetViewer.matches('.loaded') &&
          window.qtetViewer.viewing.later !== null,
      );
    for (const end = Date.now() + kTimeoutMs; !(await isThere());) {
      assert.ok(Date.now() < end, `the mesh does not come: ${messages.join('; ')}`);
      await page.waitForTimeout(50);
    }
    await page.evaluate(() => window.qtetViewer.viewing.later.actions.share());
    const styled = await page.evaluate(() => {
      const {shadowRoot} = window.qtetViewer;
      const of = (selector) => getComputedStyle(shadowRoot.querySelector(selector));
      return [of('.panel').position, of('.swatch span').backgroundImage.slice(0, 15)];
    });
    assert.deepEqual(styled, ['absolute', 'linear-gradient']);
    const seen = await browser.picture(page, 'strict-policy');
    assert.ok(coloredShare(seen) > 0.02, 'the picture is blank');
    assert.deepEqual(messages, []);
    await page.context().close();
  } finally {
    host.close();
  }
}

/** The page would only show Chromium's own words, and "Reload". */
async function saysWhatThePolicyNeeds({browser, logs, viewer: files, out}) {
  const folder = makeSite(join(out, 'policy-site'), files, logs.fin);
  const policy = kStrictPolicy.replace(" 'wasm-unsafe-eval'", '');
  const headers = {'content-security-policy': policy};
  const host = await hostFolder(folder, {nginx: false, headers});
  try {
    const viewer = await browser.open(`${host.url}?src=fin.qtet`);
    await viewer.waitForState('failed');
    const notice = await viewer.text('.notice p');
    assert.match(notice, /Content Security Policy .* script-src needs 'wasm-unsafe-eval'/);
    assert.doesNotMatch(notice, /Reload/);
  } finally {
    host.close();
  }
}

export const transportChecks = {
  worksUnderAStrictPolicy,
  saysWhatThePolicyNeeds,
  namesEachFault,
  showsWhatATokenOpens,
  showsWhichPartOfTheCurveIsHere,
  playsASeries,
  readsAFileOnlySoFar,
  readsALogFromAPlainWebServer,
  saysThatAFileIsMissing,
  takesRangesAndChunksFromAServer,
  goesOnOverHttpWhereTheSocketIsBlocked,
};
