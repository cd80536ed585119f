// Hundreds of random actions of a user in a hurry, with faults between them. Then everything must
// be as on a fresh page with the same address. A seed repeats its actions: QTET_MONKEY=SEED,ACTIONS
// runs another one.

import assert from 'node:assert/strict';
import {copyFileSync, rmSync} from 'node:fs';
import {join} from 'node:path';
import {kTimeoutMs} from './browser.mjs';
import {expectWhole} from './expect.mjs';
import {differingShare} from './png.mjs';
import {PoorLine} from './poor_line.mjs';

const kSmall = {viewport: {width: 480, height: 320}};
const [kSeed = 7, kActions = 120] = (process.env.QTET_MONKEY ?? '')
  .split(',')
  .filter((text) => text !== '')
  .map(Number);

/** Marsaglia's xorshift: numbers in [0, 1). */
function randomOf(seed) {
  let state = (seed * 2654435761) >>> 0 || 1;
  return () => {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    return (state >>> 0) / 2 ** 32;
  };
}

async function staysSoundWhateverIsDone({server, browser, logs}) {
  const path = join(logs.fin.folder, 'monkey.qtet');
  copyFileSync(join(logs.fin.folder, 'fin.qtet'), path);
  server.kill();
  await server.start();
  const random = randomOf(kSeed);
  const pick = (...all) => all[Math.floor(all.length * random())];
  const share = () => random().toFixed(2);
  const line = await PoorLine.open(server.port, {bytesPerSecond: 400000, streamsOnly: true});
  const viewer = await browser.open(`${line.url}?mesh=monkey`, kSmall);
  const {page} = viewer;
  const set = (name, value) =>
    page.evaluate(
      ([key, text]) =>
        text === null
          ? window.qtetViewer.removeAttribute(key)
          : window.qtetViewer.setAttribute(key, text),
      [name, value],
    );
  const call = (name, ...words) =>
    page.evaluate(([method, its]) => void window.qtetViewer[method](...its), [name, words]);
  let shown = 'fin';
  const actions = {
    field: () =>
      set('field', pick('Density', 'Pressure', 'Velocity', 'Velocity[1]', 'nothing', null)),
    colormap: () => set('colormap', pick('turbo', 'grey reversed', 'cividis', null)),
    range: () => set('range', pick('symmetric', '0.5,2', null)),
    scale: () => set('scale', pick('log', null)),
    edges: () => set('edges', pick('off', null)),
    creases: () => set('creases', pick('off', null)),
    surface: () => set('surface', pick('off', null, null)),
    opacity: () => set('opacity', pick('0.3', null)),
    clip: () =>
      set('clip', pick(`x:${share()}`, `-y:${share()} z:${share()}`, `1,0,1:${share()}`, null)),
    clipMode: () => set('clip-mode', pick('cells', 'slice', null)),
    iso: () => set('iso', pick(`Density=${(1 + 2 * random()).toFixed(2)}`, 'Pressure=1,2', null)),
    threshold: () => set('threshold', pick('Density=1.2,3', 'Pressure=0.5,2', null)),
    volume: () => set('volume', pick('0,0.1,0.3', null, null)),
    quality: () =>
      set(
        'quality',
        pick(
          `cells:${Math.round(200000 * random())}`,
          `bytes:${Math.round(3e5 * random())}`,
          '2%',
          null,
          null,
        ),
      ),
    pause: () => call('pause'),
    resume: () => call('resume'),
    key: () =>
      page.evaluate(
        (key) =>
          window.qtetViewer.shadowRoot
            .querySelector('.scene')
            .dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true})),
        pick(
          'ArrowLeft',
          'ArrowUp',
          '+',
          '-',
          'Home',
          '1',
          '5',
          'o',
          'c',
          '[',
          ']',
          ' ',
          'i',
          'Escape',
        ),
      ),
    drag: async () => {
      await page.mouse.move(100 + 200 * random(), 100 + 100 * random());
      await page.mouse.down();
      await page.mouse.move(100 + 200 * random(), 100 + 100 * random(), {steps: 2});
      await page.mouse.up();
    },
    wheel: () => page.mouse.wheel(0, 200 * (random() - 0.5)),
    projection: () => set('projection', pick('parallel', null)),
    transport: () => set('transport', pick('websocket', 'range', 'chunks', null)),
    mesh: () => set('mesh', pick('monkey', 'box', 'monkey')),
    resize: () =>
      page.setViewportSize({
        width: 300 + Math.round(400 * random()),
        height: 320 + Math.round(200 * random()),
      }),
    picture: () => page.evaluate(() => void window.qtetViewer.picture().catch(() => undefined)),
    lose: () =>
      viewer
        .inView(
          async (
            {
              scene: {
                graphics: {gl},
              },
            },
            ms,
          ) => {
            const loss = gl.getExtension('WEBGL_lose_context');
            if (!loss || gl.isContextLost()) return;
            loss.loseContext();
            await new Promise((resolve) => setTimeout(resolve, ms));
            loss.restoreContext();
          },
          Math.round(100 * random()),
        )
        .catch(() => undefined), // the worker may have been replaced just now
    cut: () => line.cut(),
    restart: async () => {
      server.kill();
      if (random() < 0.5) shown = shown === 'fin' ? 'box' : 'fin';
      copyFileSync(join(logs.fin.folder, `${shown}.qtet`), path);
      await server.start();
    },
    again: () =>
      page.evaluate(() => {
        const viewer = window.qtetViewer;
        const parent = viewer.parentElement;
        viewer.remove();
        parent.append(viewer);
      }),
    hide: () =>
      page.evaluate(() => {
        window.qtetViewer.style.display = window.qtetViewer.style.display === 'none' ? '' : 'none';
      }),
    none: () => page.waitForTimeout(300 * random()),
  };
  const done = [];
  try {
    for (let i = 0; i < kActions; ++i) {
      const name = pick(...Object.keys(actions));
      done.push(name);
      await actions[name]();
      if (random() < 0.3) await page.waitForTimeout(60 * random());
    }
    // Then calm: the address holds the wanted state, and the whole mesh is wanted.
    line.bytesPerSecond = Infinity;
    await page.setViewportSize(kSmall.viewport);
    await page.evaluate(() => {
      const viewer = window.qtetViewer;
      viewer.style.display = '';
      viewer.setAttribute('mesh', 'monkey');
      viewer.removeAttribute('quality');
      viewer.shadowRoot.querySelector('.dismiss').click();
      if (viewer.state === 'failed') viewer.shadowRoot.querySelector('.retry').click();
      viewer.resume();
    });
    const log = logs[shown];
    await page.waitForFunction(
      (digest) =>
        window.qtetViewer.state === 'complete' &&
        window.qtetViewer.digest().then((its) => its === digest),
      log.meshDigest,
      {timeout: kTimeoutMs, polling: 200},
    );
    await expectWhole(viewer, log);
    const rest = async (its) => {
      await its.page.addStyleTag({
        content:
          'qtet-viewer::part(panel), qtet-viewer::part(legend), qtet-viewer::part(notice), ' +
          'qtet-viewer::part(result) { display: none }',
      });
      await its.waitInView(
        ({scene: {volume}, frames: {requested, moved}}) =>
          requested === 0 && !moved && (!volume?.hasCells || volume.atRest),
      );
      await its.settle();
    };
    const same = async () => {
      await rest(viewer);
      const query = await page.evaluate(() =>
        new URLSearchParams([...window.qtetViewer.view]).toString(),
      );
      const again = await browser.open(`${server.url}?${query}`, kSmall);
      await again.waitForState('complete');
      await again.waitForPicture();
      await rest(again);
      await rest(again);
      const differing = differingShare(
        await viewer.screenshot('monkey'),
        await again.screenshot('monkey-fresh'),
      );
      assert.ok(
        differing < 0.01,
        `${differing} of the picture is another than a fresh page's with ${query}`,
      );
    };
    await same();
    assert.deepEqual(viewer.problems, []);
    return `${kActions} actions`;
  } catch (thrown) {
    const now = await page.evaluate(() =>
      JSON.stringify([
        window.qtetViewer.state,
        window.qtetViewer.statistics,
        window.qtetViewer.shadowRoot.querySelector('.notice').innerText,
      ]),
    );
    throw new Error(
      `seed ${kSeed}, after ${done.length} actions, the last ${done.slice(-30).join(', ')}; it ` +
        `stands at ${now}; problems: ${viewer.problems.join('\n')}`,
      {cause: thrown},
    );
  } finally {
    line.close();
    rmSync(path, {force: true});
  }
}

export const monkeyChecks = {staysSoundWhateverIsDone};
