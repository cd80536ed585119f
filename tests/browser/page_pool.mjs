// Pages that serve one check after another. A new page costs seconds of processors: its process
// compiles the viewer's scripts and modules again.

/** Each holds a process and its memory. */
const kMaxIdle = 4;
const kListened = ['console', 'download', 'pageerror', 'request', 'response'];

export class PagePool {
  #browser;
  /** Pages that no check uses: {page, devtools, kind}. */
  #idle = [];
  #used = new Map();

  constructor(browser) {
    this.#browser = browser;
  }

  /** `device`: the options of Playwright's context. */
  async take(device) {
    const {viewport, colorScheme = 'light', ...others} = device;
    const kind = JSON.stringify(others);
    const at = this.#idle.findIndex((its) => its.kind === kind);
    if (at < 0) return this.#make(device, kind);
    const [its] = this.#idle.splice(at, 1);
    this.#used.set(its.page, its);
    await its.page.setViewportSize(viewport);
    await its.page.emulateMedia({colorScheme});
    return its.page;
  }

  /** Makes the page as a new one, but for what its process has compiled. */
  async giveBack(page) {
    const its = this.#used.get(page);
    this.#used.delete(page);
    if (!its || page.isClosed()) return undefined;
    try {
      await reset(its);
    } catch {
      return page.context().close();
    }
    this.#idle.push(its);
    if (this.#idle.length > kMaxIdle) await this.#idle.shift().page.context().close();
  }

  /** Closes the pages that no check uses. */
  async empty() {
    for (const {page} of this.#idle.splice(0)) await page.context().close();
  }

  async #make(device, kind) {
    const context = await toldContext(this.#browser, device);
    const page = await context.newPage();
    this.#used.set(page, {page, devtools: await context.newCDPSession(page), kind});
    return page;
  }
}

/** A context whose viewers have said already that the graphics are software. */
export async function toldContext(browser, device) {
  const context = await browser.newContext(device);
  await context.addInitScript(() => {
    try {
      sessionStorage.setItem('qtet-software-graphics', 'told');
    } catch {
      // some pages may keep nothing
    }
  });
  return context;
}

async function reset({page, devtools}) {
  for (const type of kListened) page.removeAllListeners(type);
  await page.unrouteAll({behavior: 'ignoreErrors'});
  await page.evaluate(clearStorage);
  await page.mouse.move(-1, -1); // outside, where the pointer of a new page is
  await page.goto('about:blank');
  await devtools.send('Network.clearBrowserCache');
  await devtools.send('Page.resetNavigationHistory');
}

function clearStorage() {
  try {
    localStorage.clear();
    sessionStorage.clear();
  } catch {
    // a page may have been forbidden to have any
  }
}
