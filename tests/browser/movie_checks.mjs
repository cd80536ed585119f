// Movies of a series: made in the dialog, played back by the browser, and cancelled.

import assert from 'node:assert/strict';
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {kCoarsePhone, kSmallDesktop} from './browser.mjs';
import {makeLog} from './programs.mjs';

/** Plays the file on a page of its own. Its last instant is also sought. */
async function played(browser, file) {
  const page = await browser.blank();
  try {
    return await page.evaluate(async (base64) => {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const video = document.createElement('video');
      const event = (name) =>
        new Promise((resolve, reject) => {
          video.addEventListener(name, resolve, {once: true});
          video.addEventListener('error', () => reject(new Error(video.error.message)));
        });
      video.muted = true;
      video.src = URL.createObjectURL(new Blob([bytes], {type: 'video/webm'}));
      await event('canplaythrough');
      video.playbackRate = 4;
      void video.play();
      await event('ended');
      const {duration, videoWidth, videoHeight, currentTime} = video;
      const pixels = [];
      for (const time of [duration - 0.1, 0.1]) {
        video.currentTime = time;
        await event('seeked');
        const context = new OffscreenCanvas(videoWidth, videoHeight).getContext('2d');
        context.drawImage(video, 0, 0);
        pixels.push([...context.getImageData(0, 0, videoWidth, videoHeight).data]);
      }
      const differ = pixels[0].filter((value, i) => Math.abs(value - pixels[1][i]) > 24).length;
      const corner = pixels[0].slice(0, 3);
      return {duration, videoWidth, videoHeight, currentTime, differ, corner};
    }, file.toString('base64'));
  } finally {
    await page.context().close();
  }
}

/** The attribute, and the text of the time bar. */
const timeOf = (viewer) =>
  viewer.page.evaluate(() => {
    const {shadowRoot} = window.qtetViewer;
    const attribute = window.qtetViewer.getAttribute('time');
    return [attribute, shadowRoot.querySelector('.time input').ariaValueText];
  });

/** Presses Tab until the button has the focus, then Enter. */
async function pressByKeyboard(page, button) {
  const hasFocus = () => button.evaluate((its) => its.getRootNode().activeElement === its);
  for (let i = 0; !(await hasFocus()); ++i) {
    assert.ok(i < 30, 'Tab does not reach the button');
    await page.keyboard.press('Tab');
  }
  await page.keyboard.press('Enter');
}

/** The folders whose log is made. */
const made = new Set();

/** Opens a series of four instants at a coarse level. */
async function opened({server, browser, out, bin}, query, device) {
  const options = ['--fields', 'Density', '--measure', 'none'];
  // once a run: a folder that stays may have a log of an older format
  if (!made.has(out)) makeLog(bin, 'movie', out, ['fin', '--steps', '4'], options);
  made.add(out);
  server.kill();
  await server.start();
  const viewer = await browser.open(
    `${server.url}?mesh=movie&quality=cells:20000&${query}`,
    device,
  );
  await viewer.waitForState('held');
  await viewer.waitForPicture();
  return viewer;
}

async function makesAMovieOfASeries(context) {
  const {browser} = context;
  const viewer = await opened(context, 'time=2', kSmallDesktop);
  const {page} = viewer;
  await page.locator('qtet-viewer canvas.scene').focus();
  await page.keyboard.press('p');
  const dialog = page.getByRole('dialog', {name: 'Save picture'});
  await dialog.waitFor();
  await dialog.getByRole('textbox', {name: 'Width'}).fill('480');
  await dialog.getByRole('textbox', {name: 'Height'}).fill('321');
  await dialog.getByRole('radio', {name: 'Transparent'}).check({force: true});
  await dialog.getByRole('combobox', {name: 'Movie'}).selectOption('5 instants a second');
  assert.deepEqual(await viewer.accessibilityViolations(), []);
  const saved = page.waitForEvent('download');
  await pressByKeyboard(page, dialog.getByRole('button', {name: 'Save movie'}));
  const download = await saved;
  assert.equal(download.suggestedFilename(), 'movie_Density_clip-y-0.5.webm');
  const file = readFileSync(await download.path());
  writeFileSync(join(viewer.out, 'movie.webm'), file);
  await dialog.waitFor({state: 'hidden'});
  assert.deepEqual(await timeOf(viewer), ['2', 't = 2']);
  const {duration, videoWidth, videoHeight, currentTime, differ, corner} = await played(
    browser,
    file,
  );
  assert.deepEqual([duration, videoWidth, videoHeight, currentTime], [0.8, 480, 320, 0.8]);
  assert.ok(differ > 50, `the last instant differs from the first in ${differ} values`);
  assert.ok(Math.min(...corner) > 250, `the ground is ${corner}`);
  assert.deepEqual(viewer.problems, []);
  return `${file.length} bytes`;
}

/** Nothing is offered then, and the instant of before is shown. */
async function cancelsAMovieAndTellsWhatFails(context) {
  const viewer = await opened(context, '', kCoarsePhone);
  const {page} = viewer;
  await page.getByRole('button', {name: 'Controls'}).tap();
  await page.getByRole('button', {name: 'Save picture'}).tap();
  const dialog = page.getByRole('dialog', {name: 'Save picture'});
  const before = await timeOf(viewer);
  let downloads = 0;
  page.on('download', () => ++downloads);
  // in the page, since a busy machine may have made the movie before a tap arrives from here
  const cancelled = dialog.evaluate(
    (element) =>
      new Promise((done) => {
        const observer = new MutationObserver(() => {
          if (!element.textContent.includes('1 of 4')) return;
          observer.disconnect();
          const buttons = [...element.querySelectorAll('button')];
          buttons.find(({textContent}) => textContent.trim() === 'Cancel').click();
          done();
        });
        observer.observe(element, {subtree: true, childList: true, characterData: true});
      }),
  );
  await dialog.getByRole('button', {name: 'Save movie'}).tap();
  await cancelled;
  await dialog.getByText('Cancelled').waitFor();
  await viewer.screenshot('movie-phone');
  assert.deepEqual(await timeOf(viewer), before);
  const pngs = await page.evaluate(async () => {
    delete globalThis.VideoEncoder; // as on a page without https
    const movie = await window.qtetViewer.movie({width: 200, height: 100, onlyLoaded: true});
    const text = new TextDecoder('latin1').decode(await movie.arrayBuffer());
    return [movie.type, ...new Set(text.match(/movie-\d{4}\.png/g))];
  });
  assert.deepEqual(pngs.slice(0, 2), ['application/zip', 'movie-0001.png']);
  await page.evaluate(() => {
    window.qtetMovie = window.qtetViewer.movie({width: 200, height: 100}).then(String, String);
    window.qtetViewer.setAttribute('mesh', 'fin');
  });
  assert.match(await page.evaluate(() => window.qtetMovie), /Another mesh was opened\.$/);
  assert.equal(downloads, 0);
  assert.deepEqual(viewer.problems, []);
  return `${pngs.length - 1} instants were loaded`;
}

/** A movie has the part that plays. */
async function filmsThePartThatPlays(context) {
  const viewer = await opened(context, 'time-range=1,2', kSmallDesktop);
  const [counts, size] = await viewer.page.evaluate(async () => {
    const seen = [];
    const movie = await window.qtetViewer.movie({
      width: 160,
      height: 120,
      progress: (done, count) => seen.push(`${done} of ${count}`),
    });
    return [seen, movie.size];
  });
  assert.deepEqual(counts, ['0 of 2', '1 of 2', '2 of 2']);
  assert.ok(size > 500, `${size} bytes`);
  assert.deepEqual(viewer.problems, []);
}

export const movieChecks = {
  makesAMovieOfASeries,
  cancelsAMovieAndTellsWhatFails,
  filmsThePartThatPlays,
};
