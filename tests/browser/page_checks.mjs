// One file with the viewer and a log in it, opened from the disk without a network.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {readFileSync, statSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {kDesktop, kPhone, kTimeoutMs} from './browser.mjs';
import {expectWhole} from './expect.mjs';
import {coloredShare} from './png.mjs';

/** Makes NAME.html of a log; `options` are further words. Returns its path and what was said. */
function makePage({bin, viewer: files, out}, {folder, name}, page, ...options) {
  const path = join(out, `${page}.html`);
  const words = ['page', join(folder, `${name}.qtet`), '-o', path, '--viewer', files, ...options];
  const said = execFileSync(join(bin, 'qtet'), words, {encoding: 'utf8'});
  return {path, said};
}

/** The page in a browser without a network, and all addresses that it asks for. */
async function offline({browser}, path, query = '', device = kDesktop) {
  const asked = [];
  const viewer = await browser.open(
    pathToFileURL(path).href + query,
    {...device, offline: true},
    () => {
      const seen = (window.qtetAsked = []);
      new PerformanceObserver((list) =>
        seen.push(...list.getEntries().map(({name}) => name)),
      ).observe({type: 'resource', buffered: true});
    },
  );
  viewer.page.on('request', (request) => asked.push(request.url()));
  const outside = async () =>
    [...asked, ...(await viewer.page.evaluate(() => window.qtetAsked))].filter(
      (url) => !/^(blob|data):/.test(url),
    );
  return {viewer, outside};
}

async function opensAFileFromTheDisk(context) {
  const {path} = makePage(context, context.logs.fin, 'fin page');
  const bytes = statSync(path).size;
  for (const [device, query] of [
    [kDesktop, ''],
    [kPhone, '?field=Pressure&isosurface=2'],
  ]) {
    const {viewer, outside} = await offline(context, path, query, device);
    await viewer.waitForState('complete');
    await viewer.waitForPicture();
    await expectWhole(viewer, context.logs.fin);
    await viewer.settle();
    const picture = await viewer.screenshot(`page-${device === kPhone ? 'phone' : 'desktop'}`);
    assert.ok(coloredShare(picture) > 0.05, 'no mesh is seen');
    assert.deepEqual(await outside(), []);
    assert.deepEqual(viewer.problems, []);
    if (query) assert.match(viewer.page.url(), /field=Pressure/);
  }
  return `${bytes} bytes`;
}

/** As much of a log as fits into a number of bytes. */
async function holdsAsMuchAsFits(context) {
  const {path, said} = makePage(context, context.logs.fin, 'cut', '--max-bytes', '540k');
  assert.ok(statSync(path).size <= 540000);
  assert.match(said, /it holds [\d,]+ of 212,544 tetrahedra: boundary within [\d.]+ %/);
  const {viewer, outside} = await offline(context, path);
  for (let i = 0; i < 2; ++i) {
    await viewer.waitForState('held');
    await viewer.waitForPicture();
    const {tetrahedra} = await viewer.statistics();
    assert.ok(tetrahedra > 10000 && tetrahedra < 200000, `${tetrahedra} cells`);
    // There is nothing to go on with.
    await viewer.page.getByRole('button', {name: 'Continue'}).click();
    await viewer.settle();
  }
  await viewer.page.evaluate(() => window.qtetViewer.setAttribute('field', 'Density'));
  await viewer.page.waitForFunction(() => window.qtetViewer.state === 'held');
  await viewer.settle();
  assert.deepEqual(await outside(), []);
  assert.deepEqual(viewer.problems, []);
}

/** In a frame without an address, as a notebook's cell has it. */
async function showsInAFrame(context) {
  const {path} = makePage(context, context.logs.fin, 'cell', '--view', 'field=Density&clip=none');
  const escaped = readFileSync(path, 'utf8').replaceAll('&', '&amp;').replaceAll('"', '&quot;');
  const book = join(context.out, 'book.html');
  const frame = `<iframe srcdoc="${escaped}" style="width: 900px; height: 560px"></iframe>`;
  writeFileSync(book, `<!doctype html><h1>Notebook</h1>${frame}${frame}`);
  const page = await context.browser.blank({...kDesktop, offline: true});
  const problems = [];
  page.on('pageerror', (error) => problems.push(String(error)));
  page.on('console', (message) => message.type() === 'error' && problems.push(message.text()));
  await page.goto(pathToFileURL(book).href);
  for (const its of page.frames().slice(1)) {
    await its.waitForFunction(() => window.qtetViewer?.state === 'complete', null, {
      timeout: kTimeoutMs,
    });
    assert.equal(await its.evaluate(() => window.qtetViewer.getAttribute('field')), 'Density');
  }
  await page.waitForTimeout(1000);
  assert.ok(coloredShare(await context.browser.picture(page, 'page-in-frames')) > 0.05);
  await page.mouse.move(300, 400);
  await page.mouse.down();
  await page.mouse.move(400, 380);
  await page.mouse.up();
  await page.waitForTimeout(1000); // the view would go into the address
  assert.deepEqual(problems, []);
  await page.context().close();
}

async function saysThatAFileIsDamaged(context) {
  const {path} = makePage(context, context.logs.box, 'box page');
  const text = readFileSync(path, 'latin1');
  const at = text.indexOf('.wasm"');
  for (const [name, damaged, sentence] of [
    ['cut', text.slice(0, text.length / 2), /its end is missing/],
    ['damaged', `${text.slice(0, at + 2000)}AAAA${text.slice(at + 2004)}`, /cannot be shown/],
  ]) {
    const file = join(context.out, `${name}.html`);
    writeFileSync(file, damaged, 'latin1');
    const page = await context.browser.blank();
    await page.goto(pathToFileURL(file).href);
    const words = page.locator('.first p');
    await page.waitForFunction(
      () => document.querySelector('.first p')?.innerText !== 'Connecting',
    );
    assert.match(await words.innerText(), sentence);
    await page.context().close();
  }
}

export const pageChecks = {
  opensAFileFromTheDisk,
  holdsAsMuchAsFits,
  showsInAFrame,
  saysThatAFileIsDamaged,
};
