// The page before its scripts are there: its name, state and poster, and what is fetched then.

import assert from 'node:assert/strict';
import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {kDesktop, kPhone} from './browser.mjs';
import {coloredShare} from './png.mjs';
import {publishedOnce, Server} from './programs.mjs';
import {hostFolder} from './static_host.mjs';
import {kStrictPolicy} from './strict_policy.mjs';

/** A page whose modules never come. */
async function withoutScripts(browser, url, device = kDesktop) {
  const page = await browser.blank(device);
  await page.route('**/assets/*.js', (route) => route.abort());
  await page.goto(url);
  await page.locator('.first').waitFor();
  return page;
}

/** Waits for the poster's pixels. Returns its address. */
async function posterOf(page) {
  await page.waitForFunction(() => document.querySelector('img[slot=poster]')?.naturalWidth > 0);
  return page.evaluate(() => document.querySelector('img[slot=poster]').src);
}

async function showsNameAndPosterWithoutScripts({server, browser}) {
  for (const colorScheme of ['light', 'dark']) {
    const page = await withoutScripts(browser, `${server.url}?mesh=fin`, {
      ...kDesktop,
      colorScheme,
    });
    assert.equal(await page.locator('h1').innerText(), 'fin');
    assert.match(await page.locator('.first').innerText(), /Connecting/);
    assert.match(await posterOf(page), /\/v1\/logs\/[0-9a-f]{64}\/poster\.webp$/);
    const picture = await browser.picture(page, `poster-${colorScheme}`);
    assert.ok(coloredShare(picture) > 0.1, 'the poster is not seen');
    const [red] = picture.at(5, picture.height - 5);
    assert.ok(colorScheme === 'dark' ? red < 60 : red > 200, `the ground is not ${colorScheme}`);
    await page.context().close();
  }
}

/** The bounds of what is coloured like a field and lies beside the cards. */
function boundsOf(picture, {left = 0, top = 0, right = 0, bottom = 0}) {
  const bounds = [Infinity, Infinity, -Infinity, -Infinity];
  for (let y = top; y < picture.height - bottom; ++y)
    for (let x = left; x < picture.width - right; ++x) {
      const rgb = picture.at(x, y);
      if (Math.max(...rgb) - Math.min(...rgb) < 40) continue;
      bounds[0] = Math.min(bounds[0], x);
      bounds[1] = Math.min(bounds[1], y);
      bounds[2] = Math.max(bounds[2], x);
      bounds[3] = Math.max(bounds[3], y);
    }
  return bounds;
}

/**
 * CSS pixels by which the poster may miss the first real picture. A phone's narrow angle of view
 * has a weaker perspective than the poster's.
 */
const kMaxMiss = {desktop: 5, phone: 12};

async function thePosterStandsWhereTheMeshWillStand({server, browser, out}) {
  const said = [];
  for (const [name, device, cards] of [
    ['desktop', kDesktop, {left: 110, right: 320, bottom: 130}],
    ['phone', kPhone, {top: 210, bottom: 420}],
  ]) {
    const page = await withoutScripts(browser, `${server.url}?mesh=fin`, device);
    await posterOf(page);
    const before = boundsOf(await browser.picture(page, `poster-before-${name}`), cards);
    await page.context().close();

    const viewer = await browser.open(`${server.url}?mesh=fin`, device, () => {
      // the base mesh is the first picture, and stays
      const timer = setInterval(() => {
        if (!window.qtetViewer) return;
        clearInterval(timer);
        window.qtetViewer.setAttribute('quality', 'cells:1');
      });
    });
    await viewer.waitForState('held');
    await viewer.waitForPicture();
    const hidden = await viewer.page.evaluate(
      () => getComputedStyle(document.querySelector('qtet-viewer > img')).visibility,
    );
    assert.equal(hidden, 'hidden', 'the poster stays over the picture');
    await viewer.page.evaluate(() => window.qtetViewer.setAttribute('edges', 'off'));
    await viewer.settle();
    const after = boundsOf(await viewer.screenshot(`poster-after-${name}`), cards);
    const scale = device.deviceScaleFactor ?? 1;
    const misses = before.map((at, i) => Math.abs(at - after[i]) / scale);
    said.push(`${name} ${misses.map((miss) => miss.toFixed(1)).join(' ')}`);
    assert.ok(
      Math.max(...misses) <= kMaxMiss[name],
      `${name}: the poster's bounds are ${before}, the picture's ${after} (see ${out})`,
    );
  }
  return said.join('; ');
}

async function aGuardedMeshHasNoPoster({logs, viewer: files, out, bin}) {
  writeFileSync(join(out, 'poster-tokens'), 'read fin mq3Vt0pCk8Jx1yQ2b7nS5uEw\nread box anyone\n');
  const options = ['--tokens', join(out, 'poster-tokens')];
  const guarded = new Server(bin, logs.fin.folder, files, options);
  await guarded.start();
  try {
    const of = async (mesh) => (await fetch(`${guarded.url}?mesh=${mesh}`)).text();
    assert.doesNotMatch(await of('fin'), /poster\.webp|>fin</);
    assert.equal(await of('fin'), await of('nothing'), 'the page says that the mesh exists');
    assert.match(await of('box'), /poster\.webp/);
  } finally {
    guarded.kill();
  }
}

async function aPublishedFolderShowsThePosterOfItsAddress(context) {
  const {browser, logs} = context;
  const folder = publishedOnce(context);
  // another page's scripts come from the same folder, so this one is not blocked with the modules
  const headers = {'content-security-policy': kStrictPolicy};
  const host = await hostFolder(folder, {nginx: false, headers});
  try {
    for (const [query, name] of [
      ['', 'fin'],
      ['?mesh=box', 'box'],
    ]) {
      const page = await withoutScripts(browser, host.url + query);
      await page.waitForFunction((its) => document.querySelector('h1').innerText === its, name);
      await page.waitForFunction(
        (its) => document.querySelector('img[slot=poster]').src.endsWith(`${its}.webp`),
        name,
      );
      await posterOf(page);
      const picture = await browser.picture(page, `poster-published-${name}`);
      assert.ok(coloredShare(picture) > 0.1, 'the poster is not seen');
      await page.context().close();
    }
    const turned = await withoutScripts(browser, `${host.url}?mesh=fin&camera=0,-4,0,0,0,0`);
    await turned.waitForFunction(() => document.querySelector('h1').innerText === 'fin');
    await turned.waitForFunction(() => !document.querySelector('img[slot=poster]'));
    await turned.context().close();
    await seesWhole(browser, host, logs.fin);
  } finally {
    host.close();
  }
}

/** The mesh comes under the policy, everything once and without a complaint of the browser's. */
async function seesWhole(browser, host, log) {
  const before = host.requests.length;
  const said = [];
  const page = await browser.blank();
  page.on('console', (message) => {
    if (/preload|policy|Refused/i.test(message.text())) said.push(message.text());
  });
  await page.goto(host.url);
  await page.waitForFunction(() => window.qtetViewer?.state === 'complete', null, {
    timeout: 180000,
  });
  assert.equal(await page.evaluate(() => window.qtetViewer.digest()), log.meshDigest);
  await page.waitForTimeout(6000); // Chromium complains five seconds after the page has loaded
  assert.deepEqual(said, []);
  const paths = host.requests.slice(before).filter((line) => !/bytes=|favicon/.test(line));
  const twice = paths.filter((line, i) => paths.indexOf(line) !== i);
  assert.deepEqual(twice, [], 'a file was fetched twice');
  await page.context().close();
}

async function theWorkersComeWithThePagesScript({server, browser}) {
  const page = await browser.blank();
  const seen = [];
  await page.route('**/assets/index-*.js', (route) => route.abort());
  page.on('request', (request) => seen.push(new URL(request.url()).pathname));
  await page.goto(`${server.url}?mesh=fin`);
  await page.waitForTimeout(1000);
  for (const part of [/\/worker-.*\.js$/, /view_worker-.*\.js$/])
    assert.ok(
      seen.some((path) => part.test(path)),
      `${part} waits for the page's script; fetched: ${seen.join(' ')}`,
    );
  const runs = page.workers().map((worker) => worker.url());
  assert.match(runs.join(), /start_graphics/, "the graphics wait for the page's script");
  await page.context().close();
  const {headers} = await fetch(`${server.url}?mesh=fin`);
  assert.match(headers.get('link'), /start_graphics-[^>]*>; rel=modulepreload; crossorigin/);
  assert.match(headers.get('link'), /poster\.webp>; rel=preload; as=image/);
}

export const posterChecks = {
  showsNameAndPosterWithoutScripts,
  thePosterStandsWhereTheMeshWillStand,
  aGuardedMeshHasNoPoster,
  aPublishedFolderShowsThePosterOfItsAddress,
  theWorkersComeWithThePagesScript,
};
