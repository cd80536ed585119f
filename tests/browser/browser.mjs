// Chromium, headless with software WebGL, and the viewer's page in it.

import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {PagePool, toldContext} from './page_pool.mjs';
import {readPng} from './png.mjs';

const require = createRequire(new URL('../../web-client/package.json', import.meta.url));
const {chromium} = require('playwright-core');

export const kDesktop = {viewport: {width: 1280, height: 800}};
export const kPhone = {
  viewport: {width: 390, height: 844},
  deviceScaleFactor: 2,
  isMobile: true,
  hasTouch: true,
};
/** For pictures of a mesh alone. */
export const kScene = {viewport: {width: 480, height: 320}};
/** Their layouts at a half and a quarter of the pixels, for checks of anything but pictures. */
export const kSmallDesktop = {viewport: {width: 800, height: 600}};
export const kCoarsePhone = {...kPhone, deviceScaleFactor: 1};
/** Only patience: a machine under load needs a minute for work of seconds. */
export const kTimeoutMs = 180000;
const kSettleMs = 900;
/** A decoder that cannot be loaded answers nothing. */
const kHearingMs = 10000;
/** Set before the page's scripts run. */
const kOpenedMark = 'qtet-opened';

export class Browser {
  #browser;
  #out;
  #pages = [];
  /** Null: each page is a new one. */
  #pool = null;

  /**
   * `forChecks`: pages serve one check after another, and a processor composes them. Graphics in
   * software would do that with shaders, at three times the price; only the canvas needs them.
   */
  static async launch(out, {forChecks = false} = {}) {
    const args = [
      '--use-gl=angle',
      '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader',
      '--mute-audio',
    ];
    if (forChecks) args.push('--disable-gpu-compositing');
    if (process.getuid?.() === 0) args.push('--no-sandbox');
    const launched = new Browser();
    launched.#out = out;
    launched.#browser = await chromium.launch({
      executablePath: process.env.QTET_CHROMIUM ?? '/usr/bin/chromium',
      headless: true,
      args,
    });
    if (forChecks) launched.#pool = new PagePool(launched.#browser);
    return launched;
  }

  /**
   * Opens the viewer at `url`; `device` is kDesktop, kPhone, or either with Playwright's other
   * context options; `before` runs before the page's scripts.
   */
  async open(url, device = kDesktop, before = () => undefined) {
    const page = await (this.#pool?.take(device) ?? this.blank(device));
    page.setDefaultTimeout(kTimeoutMs);
    const viewer = new ViewerPage(page, this.#out);
    this.#pages.push(viewer);
    viewer.scripts.push(await page.addInitScript(watchEvents, kOpenedMark));
    viewer.scripts.push(await page.addInitScript(before));
    await page.goto(url);
    await page.waitForFunction(() => window.qtetViewer !== undefined, null, {
      timeout: kTimeoutMs,
    });
    return viewer;
  }

  /** With all of the mesh that is asked for, drawn. */
  async openComplete(url, device, before) {
    const viewer = await this.open(url, device, before);
    await viewer.waitForState('complete');
    await viewer.waitForPicture();
    return viewer;
  }

  /** The same, and what the page does behind it is done. */
  async openSettled(url, device, before) {
    const viewer = await this.openComplete(url, device, before);
    await viewer.settle();
    return viewer;
  }

  /**
   * Starts tracing. `end()` returns the tasks on the own thread of the one page with workers, since
   * it was opened: {ms, cpuMs} each.
   */
  async trace() {
    await this.#pool?.empty(); // they have had workers
    await this.#browser.startTracing(undefined, {
      categories: ['-*', 'toplevel', 'blink.user_timing', '__metadata'],
    });
    return {
      end: async () => {
        const {traceEvents} = JSON.parse(String(await this.#browser.stopTracing()));
        const threads = traceEvents.filter(({name}) => name === 'thread_name');
        const {pid} = threads.find(({args}) => args.name.startsWith('DedicatedWorker'));
        const {tid} = threads.find(
          (thread) => thread.pid === pid && thread.args.name === 'CrRendererMain',
        );
        const page = traceEvents.filter((event) => event.pid === pid && event.tid === tid);
        const opened = page.find(({name}) => name === kOpenedMark).ts;
        return page
          .filter(({ph, name, ts}) => ph === 'X' && name.endsWith('RunTask') && ts >= opened)
          .map(({dur, tdur = 0}) => ({ms: dur / 1000, cpuMs: tdur / 1000}));
      },
    };
  }

  /** An empty page, with a cache of its own. */
  async blank(device = kDesktop) {
    return (await toldContext(this.#browser, device)).newPage();
  }

  /** An empty page whose viewer has not said yet that the graphics are software. */
  async untold(device = kDesktop) {
    return (await this.#browser.newContext(device)).newPage();
  }

  /** Opens a page that is not ours; `receive` receives the console's errors. */
  async page(url, receive = () => undefined) {
    const page = await this.blank();
    page.on('console', (message) => message.type() === 'error' && receive(message.text()));
    await page.goto(url);
    return page;
  }

  async picture(page, name) {
    return readPng(await page.screenshot({path: join(this.#out, `${name}.png`)}));
  }

  async saveFailure(name) {
    for (const viewer of this.#pages)
      await viewer.page
        .screenshot({path: join(this.#out, `failed-${name}.png`)})
        .catch(() => undefined);
  }

  /** `areSound`: the next check may have them. */
  async closePages({areSound = true} = {}) {
    for (const {page, scripts} of this.#pages) {
      if (!this.#pool || !areSound) await page.context().close();
      else {
        for (const script of scripts) await script.dispose();
        await this.#pool.giveBack(page);
      }
    }
    this.#pages = [];
  }

  async close() {
    await this.#browser.close();
  }
}

export class ViewerPage {
  /** Uncaught errors, and console errors except those about a missing network. */
  problems = [];
  /** They run before the page's own. */
  scripts = [];

  constructor(page, out) {
    this.page = page;
    this.out = out;
    page.on('pageerror', (error) => this.problems.push(error.stack || String(error)));
    page.on('console', (message) => {
      if (message.type() === 'error' && !/ERR_|WebSocket/.test(message.text()))
        this.problems.push(message.text() || `an error without words at ${message.location().url}`);
    });
  }

  /**
   * Waits for a state that results from all earlier commands, not for one that is about to change.
   * If the viewer fails instead, throws its message.
   */
  async waitForState(wanted) {
    await this.#flushCommands();
    await this.page.waitForFunction(
      (state) => [state, 'failed'].includes(window.qtetViewer.state),
      wanted,
      {timeout: kTimeoutMs, polling: 50},
    );
    const state = await this.page.evaluate(() => window.qtetViewer.state);
    if (state === 'failed' && wanted !== 'failed')
      throw new Error(`the viewer failed: ${await this.text('.notice p')}`);
    if (['complete', 'failed', 'held'].includes(wanted)) await this.waitForControls();
  }

  /** They come behind the first picture, or an error. */
  async waitForControls() {
    await this.page.waitForFunction(() => window.qtetViewer.viewing?.later, null, {
      timeout: kTimeoutMs,
    });
  }

  /** Waits until the picture of the current figures has been drawn, and one more frame. */
  async waitForPicture() {
    await this.page.waitForFunction(() => window.qtetSeen.pictures > 0, null, {
      timeout: kTimeoutMs,
    });
    await this.waitForControls();
    await this.settle();
  }

  /**
   * Waits until the last change has been computed and drawn. It waits for a while, then for the
   * decoder, then for frames of the page and of the worker that draws. All of them are late under
   * load.
   */
  async settle() {
    await this.page.waitForTimeout(kSettleMs);
    await this.#flushCommands();
    await this.#waitForDecoder();
    const frame = () =>
      new Promise((drawn) => {
        requestAnimationFrame(drawn);
      });
    for (let i = 0; i < 2; ++i) {
      await this.page.evaluate(frame);
      await this.inView(frame);
    }
  }

  /**
   * Waits until the decoder has received the page's commands, and the page the immediate answers.
   * Does nothing for a decoder that never started.
   */
  async #flushCommands() {
    await this.page.evaluate(
      (ms) =>
        Promise.race([
          window.qtetViewer.digest(),
          new Promise((resolve) => {
            setTimeout(resolve, ms);
          }),
        ]),
      kHearingMs,
    );
  }

  /** Waits until no picture is due or under way. */
  async #waitForDecoder() {
    for (
      const end = Date.now() + kTimeoutMs;
      Date.now() < end;
      await this.page.waitForTimeout(20)
    ) {
      const busy = this.page
        .workers()
        .filter((worker) => /\/worker\b/.test(worker.url()))
        .map((worker) => worker.evaluate(() => globalThis.qtetPublisher?.isBusy === true));
      if (!(await Promise.all(busy)).includes(true)) return;
    }
    throw new Error('pictures have been under way for minutes');
  }

  /**
   * The violations of WCAG 2.2 AA that axe-core finds, including shadow roots, as "rule: element".
   */
  async accessibilityViolations() {
    // so that the page's policy does not forbid it
    await this.page.evaluate(`${readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8')};0`);
    return this.page.evaluate(async () => {
      const {violations} = await window.axe.run(document, {
        runOnly: ['wcag2a', 'wcag2aa', 'wcag21aa', 'wcag22aa', 'best-practice'],
      });
      return violations.flatMap(({id, nodes}) =>
        nodes.map(({target, failureSummary}) => `${id}: ${target.join(' ')} ${failureSummary}`),
      );
    });
  }

  /**
   * Calls `look` with the MeshView in the worker that draws, or on the page if there is no such
   * worker.
   */
  inView(look, ...words) {
    const thread =
      this.page.workers().find((worker) => worker.url().includes('view_worker')) ?? this.page;
    return thread.evaluate(
      ([text, its]) =>
        (0, eval)(`(${text})`)(globalThis.qtetView ?? globalThis.qtetViewer.meshView, ...its),
      [String(look), words],
    );
  }

  async waitInView(isSo) {
    for (const end = Date.now() + kTimeoutMs; Date.now() < end; await this.page.waitForTimeout(50))
      if (await this.inView(isSo)) return;
    throw new Error(`the view does not become so: ${isSo}`);
  }

  /** Waits for a volume with all its cells and pixels, seen from where the camera is. */
  async restVolume() {
    // Twice, because the last command may not have reached the worker that draws.
    for (let i = 0; i < 2; ++i) {
      await this.settle();
      const isAtRest = ({scene: {volume}, frames: {requested, moved}}) =>
        volume?.hasCells && volume.atRest && requested === 0 && !moved;
      await this.waitInView(isAtRest).catch(async (error) => {
        const state = await this.inView(({scene: {volume}, frames: {requested, moved}}) => {
          const {whole, busy, interrupted, waiting, timer, wholeMs} = volume ?? {};
          const waits = timer !== undefined;
          return {whole, busy, interrupted, waiting, waits, wholeMs, requested, moved};
        });
        throw new Error(`${error.message}; it is ${JSON.stringify(state)}`);
      });
    }
  }

  /** They come behind the first picture. */
  async waitForLines() {
    const [worker] = this.page.workers().filter((its) => /\/worker\b/.test(its.url()));
    for (const end = Date.now() + kTimeoutMs; Date.now() < end; await this.page.waitForTimeout(50))
      if (await worker.evaluate(() => globalThis.qtetPublisher.hasCreases)) return this.settle();
    throw new Error('there are no lines');
  }

  statistics() {
    return this.page.evaluate(() => window.qtetViewer.statistics);
  }
  counts() {
    return this.page.evaluate(() => window.qtetViewer.counts);
  }
  digest() {
    return this.page.evaluate(() => window.qtetViewer.digest());
  }
  /** The pictures and events that the init scripts saw, by name. */
  seen() {
    return this.page.evaluate(() => window.qtetSeen);
  }
  text(selector) {
    return this.page.locator(`qtet-viewer ${selector}`).innerText();
  }

  /** Writes OUT/NAME.png and returns its pixels. */
  async screenshot(name) {
    return readPng(await this.page.screenshot({path: join(this.out, `${name}.png`)}));
  }
}

/**
 * Browser.open's `before`: these parts are never there. The mesh is fitted beside the cards of its
 * first picture, and a style added to the open page may come after that.
 */
export const hides = (...parts) => ({
  content: `const hidden = new CSSStyleSheet();
    hidden.replaceSync('${parts.map((part) => `qtet-viewer::part(${part})`)} {display: none}');
    document.adoptedStyleSheets.push(hidden);`,
});

/** Runs in the page before its scripts. */
function watchEvents(mark) {
  performance.mark(mark);
  const seen = {pictures: 0, events: []};
  window.qtetSeen = seen;
  const listen = (event) => {
    const {type, target, detail} = event;
    if (target.localName !== 'qtet-viewer') return;
    if (type === 'load' || type === 'refine') ++seen.pictures;
    if (type !== 'progress') seen.events.push({type, at: performance.now(), bytes: detail?.bytes});
  };
  for (const type of ['load', 'refine', 'progress', 'complete', 'error'])
    document.addEventListener(type, listen, true);
}
