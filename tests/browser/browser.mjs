// Chromium, headless with software WebGL, and the viewer's page in it.

import {createRequire} from 'node:module';
import {join} from 'node:path';
import {readPng} from './png.mjs';

const require = createRequire(new URL('../../web-client/package.json', import.meta.url));
const {chromium} = require('playwright-core');

export const kDesktop = {viewport: {width: 1280, height: 800}};
export const kPhone = {viewport: {width: 390, height: 844}, deviceScaleFactor: 2, isMobile: true, hasTouch: true};
export const kTimeoutMs = 60000;
const kSettleMs = 900;

export class Browser {
  #browser;
  #out;
  #pages = [];

  static async launch(out) {
    const args = ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--mute-audio'];
    if (process.getuid?.() === 0) args.push('--no-sandbox');
    const launched = new Browser();
    launched.#out = out;
    launched.#browser = await chromium.launch({executablePath: process.env.QTET_CHROMIUM ?? '/usr/bin/chromium', headless: true, args});
    return launched;
  }

  /** Opens the viewer at `url`; `device` is kDesktop, kPhone, or either with Playwright's other context options. */
  async open(url, device = kDesktop) {
    const context = await this.#browser.newContext(device);
    const page = await context.newPage();
    const viewer = new ViewerPage(page, this.#out);
    this.#pages.push(viewer);
    await page.addInitScript(watchTasksAndEvents);
    await page.goto(url);
    await page.waitForFunction(() => window.qtetViewer !== undefined, null, {timeout: kTimeoutMs});
    return viewer;
  }

  /** A page that is none of ours. */
  async page(url) {
    const page = await (await this.#browser.newContext(kDesktop)).newPage();
    await page.goto(url);
    return page;
  }

  async picture(page, name) { return readPng(await page.screenshot({path: join(this.#out, `${name}.png`)})); }

  async saveFailure(name) {
    for (const viewer of this.#pages) await viewer.page.screenshot({path: join(this.#out, `failed-${name}.png`)}).catch(() => undefined);
  }

  async closePages() {
    for (const viewer of this.#pages) await viewer.page.context().close();
    this.#pages = [];
  }

  async close() { await this.#browser.close(); }
}

export class ViewerPage {
  /** Uncaught errors and console errors other than a network that is not there. */
  problems = [];

  constructor(page, out) {
    this.page = page;
    this.out = out;
    page.on('pageerror', (error) => this.problems.push(String(error.stack ?? error)));
    page.on('console', (message) => {
      if (message.type() === 'error' && !/ERR_|WebSocket/.test(message.text())) this.problems.push(message.text());
    });
  }

  /** Throws what the viewer says when it fails instead. */
  async waitForState(wanted) {
    await this.page.waitForFunction((state) => [state, 'failed'].includes(window.qtetViewer.state), wanted, {timeout: kTimeoutMs, polling: 50});
    const state = await this.page.evaluate(() => window.qtetViewer.state);
    if (state === 'failed' && wanted !== 'failed') throw new Error(`the viewer failed: ${await this.text('.notice p')}`);
  }

  /** Waits until the picture of the figures' moment has been drawn, and one frame more. */
  async waitForPicture() {
    await this.page.waitForFunction(() => window.qtetSeen.pictures > 0, null, {timeout: kTimeoutMs});
    await this.page.waitForTimeout(600);
  }

  /** Waits until what was just changed has been computed and drawn. */
  settle() { return this.page.waitForTimeout(kSettleMs); }

  /** What axe-core finds against WCAG 2.2 AA, shadow roots included: "rule: element" each. */
  async accessibilityViolations() {
    await this.page.addScriptTag({path: require.resolve('axe-core/axe.min.js')});
    return this.page.evaluate(async () => {
      const {violations} = await window.axe.run(document, {runOnly: ['wcag2a', 'wcag2aa', 'wcag21aa', 'wcag22aa', 'best-practice']});
      return violations.flatMap(({id, nodes}) => nodes.map(({target, failureSummary}) => `${id}: ${target.join(' ')} ${failureSummary}`));
    });
  }

  statistics() { return this.page.evaluate(() => window.qtetViewer.statistics); }
  counts() { return this.page.evaluate(() => window.qtetViewer.counts); }
  digest() { return this.page.evaluate(() => window.qtetViewer.digest()); }
  /** What init scripts saw: pictures, events by name, long tasks. */
  seen() { return this.page.evaluate(() => window.qtetSeen); }
  text(selector) { return this.page.locator(`qtet-viewer ${selector}`).innerText(); }

  /** Writes OUT/NAME.png and gives its pixels. */
  async screenshot(name) {
    return readPng(await this.page.screenshot({path: join(this.out, `${name}.png`)}));
  }
}

/** Runs in the page before its scripts. */
function watchTasksAndEvents() {
  const seen = {pictures: 0, events: [], longTasks: [], loadedAt: 0};
  window.qtetSeen = seen;
  new PerformanceObserver((list) => {
    for (const entry of list.getEntries()) seen.longTasks.push({start: entry.startTime, ms: entry.duration});
  }).observe({type: 'longtask', buffered: true});
  document.addEventListener('DOMContentLoaded', () => {
    const viewer = document.querySelector('qtet-viewer');
    for (const type of ['load', 'refine', 'progress', 'complete', 'error']) {
      viewer.addEventListener(type, (event) => {
        if (type === 'load' || type === 'refine') ++seen.pictures;
        if (type === 'load') seen.loadedAt = performance.now();
        if (type !== 'progress') seen.events.push({type, at: performance.now(), bytes: event.detail?.bytes});
      });
    }
  });
}
