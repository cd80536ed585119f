// The element, used at awkward moments.

import assert from 'node:assert/strict';
import {copyFileSync, rmSync} from 'node:fs';
import {join} from 'node:path';
import {kPhone, kTimeoutMs} from './browser.mjs';
import {expectWhole} from './expect.mjs';
import {coloredShare, differingShare} from './png.mjs';
import {PoorLine} from './poor_line.mjs';

/** A picture of the previous mesh is already on its way when another mesh is chosen. */
async function showsNothingOfTheMeshBefore({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin`, undefined, () => {
    const seen = (window.qtetSwitch = {before: 0, loads: []});
    window.Worker = class extends window.Worker {
      constructor(url, options) {
        super(url, options);
        if (options?.name !== 'qtet') return;
        this.addEventListener('message', ({data}) => {
          // receives it before the viewer does
          if (data.type !== 'snapshot' || seen.before > 0) return;
          seen.before = data.snapshot.statistics.total.tetrahedra;
          const viewer = document.querySelector('qtet-viewer');
          viewer.addEventListener('load', ({detail}) => seen.loads.push(detail.total.tetrahedra));
          const menu = viewer.shadowRoot.querySelector('select[name=mesh]');
          menu.value = 'box';
          menu.dispatchEvent(new Event('change'));
        });
      }
    };
  });
  await viewer.page.waitForFunction(() => window.qtetSwitch.loads.length > 0, null, {
    timeout: kTimeoutMs,
  });
  await viewer.waitForState('complete');
  const {before, loads} = await viewer.page.evaluate(() => window.qtetSwitch);
  const {total} = await viewer.statistics();
  assert.notEqual(before, total.tetrahedra);
  assert.deepEqual(loads, [total.tetrahedra]);
}

/** Looks at the contents of the first picture, and at the view's commands before it. */
async function holdsTheAddressFromTheFirstPictureOn({server, browser}) {
  const view = 'clip=y:0.5&iso=Density=1.3&threshold=Density=0.5,4&range=1,3&projection=parallel';
  const viewer = await browser.open(`${server.url}?mesh=fin&${view}`, undefined, () => {
    const first = (window.qtetFirst = {picture: null, commands: [], isShown: false});
    window.Worker = class extends window.Worker {
      constructor(url, options) {
        super(url, options);
        this.addEventListener('message', ({data}) => {
          if (data.type !== 'snapshot' || first.picture) return;
          const {planes, cuts, color, isosurface} = data.snapshot;
          first.picture = {
            planes: planes.length,
            cuts: cuts.map(({values}) => values.length > 0),
            isColored: color !== null,
            hasIsosurface: isosurface.positions.length > 0,
          };
        });
      }
      postMessage(message, ...rest) {
        super.postMessage(message, ...rest);
        if (message.type === 'show') first.isShown = true;
        if (message.type === 'command' && !first.isShown)
          first.commands.push([message.name, message.words[0]]);
      }
    };
  });
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const {picture, commands} = await viewer.page.evaluate(() => window.qtetFirst);
  assert.deepEqual(picture, {planes: 1, cuts: [true], isColored: true, hasIsosurface: true});
  const said = new Map(commands);
  assert.equal(said.get('setRange'), 1);
  assert.equal(said.get('setParallel'), true);
  assert.deepEqual(viewer.problems, []);
}

/**
 * The graphics are so slow that the whole mesh is decoded before the first picture is on the
 * screen.
 */
async function tellsOfTheWholeMeshOnceItIsDrawn({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin`, undefined, () => {
    const reported = (window.qtetReported = {complete: [], last: null});
    document.addEventListener('DOMContentLoaded', () => {
      const viewer = document.querySelector('qtet-viewer');
      viewer.addEventListener('complete', ({detail}) => reported.complete.push(detail.tetrahedra));
      viewer.addEventListener('refine', ({detail}) => void (reported.last = detail));
    });
    window.Worker = class extends window.Worker {
      constructor(url, options) {
        super(url, options);
        this.isView = options?.name === 'qtet-view';
      }
      set onmessage(listener) {
        const held = [];
        super.onmessage = !this.isView
          ? listener
          : (event) => {
              const viewer = document.querySelector('qtet-viewer');
              const isDecoded = () => viewer.viewing?.stream.state === 'complete';
              if (event.data.type !== 'shown' || isDecoded()) return listener(event);
              if (held.push(event) > 1) return undefined;
              const wait = setInterval(() => {
                if (!isDecoded()) return;
                clearInterval(wait);
                for (const event of held) listener(event);
              }, 5);
              return undefined;
            };
      }
    };
  });
  await viewer.page.waitForFunction(
    () =>
      window.qtetReported.last?.tetrahedra === window.qtetReported.last?.total.tetrahedra &&
      window.qtetReported.last,
    null,
    {timeout: kTimeoutMs},
  );
  const {complete, last} = await viewer.page.evaluate(() => window.qtetReported);
  assert.deepEqual(complete, [last.total.tetrahedra]);
}

/**
 * The whole mesh is decoded before there is a view. The picture that waited is old, but the figures
 * must be new.
 */
async function tellsTheNewestFiguresWithAnOldPicture({server, browser, logs}) {
  const viewer = await browser.open(`${server.url}?mesh=fin`, undefined, () => {
    const states = (window.qtetStates = []);
    document.addEventListener('DOMContentLoaded', () => {
      const viewer = document.querySelector('qtet-viewer');
      viewer.addEventListener(
        'load',
        ({detail}) => void (window.qtetLoad = [detail.tetrahedra, viewer.statistics.tetrahedra]),
      );
    });
    window.Worker = class extends window.Worker {
      constructor(url, options) {
        super(url, options);
        if (options?.name === 'qtet-view') this.wait = [];
      }
      set onmessage(listener) {
        super.onmessage = (event) => {
          const viewer = document.querySelector('qtet-viewer');
          const isDecoded = () => viewer.viewing?.stream.state === 'complete';
          if (!this.wait || isDecoded()) return listener(event);
          states.push(viewer.state);
          if (this.wait.push(event) > 1) return undefined;
          const timer = setInterval(() => {
            if (!isDecoded()) return;
            states.push(viewer.state);
            clearInterval(timer);
            for (const held of this.wait) listener(held);
          }, 5);
          return undefined;
        };
      }
    };
  });
  await viewer.page.waitForFunction(() => window.qtetLoad, null, {timeout: kTimeoutMs});
  const [shown, reported] = await viewer.page.evaluate(() => window.qtetLoad);
  const {total} = await viewer.statistics();
  assert.ok(shown < total.tetrahedra, 'the first picture is no old one');
  const blank = await viewer.page.evaluate(() => window.qtetStates);
  assert.ok(blank.length > 0 && !blank.includes('complete'), 'a blank canvas is called complete');
  assert.equal(reported, total.tetrahedra);
  await viewer.waitForState('complete');
  await expectWhole(viewer, logs.fin);
}

/** A page sets the attributes in the task that appends the element. */
async function takesItsAttributesInTheTaskThatAppendsIt({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=box`);
  await viewer.page.evaluate(() => {
    const late = (window.qtetViewer = document.createElement('qtet-viewer'));
    document.querySelector('qtet-viewer').replaceWith(late);
    late.setAttribute('src', '/nowhere.qtet');
    late.token = 'any';
  });
  await viewer.waitForState('failed');
  assert.match(await viewer.text('.notice p'), /nowhere\.qtet/);
  assert.deepEqual(
    viewer.problems.filter((problem) => problem.includes('TypeError')),
    [],
  );
}

/** A pause before there is a stream: nothing is requested until it ends. */
async function pausesInTheTaskThatAppendsIt({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=box`);
  await viewer.waitForState('complete');
  await viewer.page.evaluate(() => {
    const late = (window.qtetViewer = document.createElement('qtet-viewer'));
    late.setAttribute('mesh', 'fin');
    document.querySelector('qtet-viewer').replaceWith(late);
    late.pause();
  });
  await viewer.waitForState('paused');
  await viewer.settle();
  assert.equal((await viewer.statistics()).bytes, 0);
  assert.equal(await viewer.page.evaluate(() => window.qtetViewer.state), 'paused');
  await viewer.page.getByRole('button', {name: 'Continue'}).click();
  await viewer.waitForState('complete');
  assert.deepEqual(viewer.problems, []);
}

/** Requests of a page in the task that appends the element are kept until they can be done. */
async function keepsWhatIsAskedForBeforeThereIsAMesh({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=box`);
  await viewer.waitForState('complete');
  await viewer.page.evaluate(() => {
    const late = (window.qtetViewer = document.createElement('qtet-viewer'));
    late.setAttribute('mesh', 'fin');
    document.querySelector('qtet-viewer').replaceWith(late);
    late.look('+z');
    late.pause();
    window.qtetRange = new Promise((chosen) => {
      const choose = setInterval(() => {
        if (!late.viewing?.later) return;
        clearInterval(choose);
        const select = late.shadowRoot.querySelector('select[name=range]');
        select.value = 'fixed';
        select.dispatchEvent(new Event('change'));
        late.resume();
        chosen();
      });
    });
  });
  await viewer.waitForState('complete');
  await viewer.settle();
  const {direction, range} = await viewer.page.evaluate(async () => {
    await window.qtetRange;
    const {meshView} = window.qtetViewer;
    return {direction: meshView.pose.direction, range: window.qtetViewer.getAttribute('range')};
  });
  assert.ok(direction[2] < -0.99, `the first picture is seen along ${direction}`);
  assert.match(range ?? '', /^[\d.]+,[\d.]+$/);
}

/** A page may move the element: a tab, a dialog. */
async function keepsCameraAndMeshWhereverItMoves({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  const camera = [1, -2, 1.5, 0.1, 0, 0];
  const reported = await viewer.page.evaluate(async (state) => {
    const {qtetViewer} = window;
    qtetViewer.cameraState = state;
    const {client} = qtetViewer;
    const place = document.createElement('section');
    document.body.append(place);
    place.append(qtetViewer);
    await new Promise((later) => {
      setTimeout(later, 100);
    });
    return {isSame: qtetViewer.client === client, state: qtetViewer.state};
  }, camera);
  assert.deepEqual(reported, {isSame: true, state: 'complete'});
  await viewer.page.evaluate(async () => {
    const {qtetViewer} = window;
    qtetViewer.remove();
    await new Promise((later) => {
      setTimeout(later, 100);
    });
    document.body.append(qtetViewer);
  });
  await viewer.waitForState('complete');
  assert.deepEqual(await viewer.page.evaluate(() => window.qtetViewer.cameraState), camera);
  assert.deepEqual(viewer.problems, []);
}

/** uPlot keeps each plot that is not destroyed, and with it the whole element. */
async function leavesNothingBehind({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=box`);
  const {page} = viewer;
  await viewer.waitForState('complete');
  await page.evaluate(async () => {
    const pause = (ms) =>
      new Promise((later) => {
        setTimeout(later, ms);
      });
    const until = async (isSo) => {
      while (!isSo()) await pause(20);
    };
    const openAndRemove = async (hasPlot) => {
      const element = document.createElement('qtet-viewer');
      element.setAttribute('mesh', 'box');
      element.style.cssText = 'display: block; width: 400px; height: 300px';
      const whole = new Promise((done) => {
        element.addEventListener('complete', done, {once: true});
      });
      document.body.append(element);
      await whole;
      const {shadowRoot, viewing} = element;
      if (hasPlot) {
        await until(() => viewing.later);
        const {inspect} = viewing.later.panels;
        inspect.use('line');
        await inspect.click(190, 150);
        await inspect.click(215, 155);
        await until(() => shadowRoot.querySelector('.plot canvas'));
      }
      element.remove();
      return [new WeakRef(element), new WeakRef(shadowRoot.querySelector('.panel'))];
    };
    window.qtetLeft = [await openAndRemove(false), await openAndRemove(true)].flat();
  });
  const devtools = await page.context().newCDPSession(page);
  const left = async () => {
    await devtools.send('HeapProfiler.collectGarbage');
    return page.evaluate(() => window.qtetLeft.map((one) => one.deref() !== undefined));
  };
  for (const end = Date.now() + kTimeoutMs; (await left()).some(Boolean);) {
    assert.ok(Date.now() < end, `removed elements stay in memory: ${await left()}`);
    await page.waitForTimeout(100);
  }
}

/** After an error in one picture, the next ones are drawn. */
async function drawsOnAfterAPictureThatFailed({server, browser}) {
  for (const breakOnce of [
    ({
      scene: {
        parts: {surface},
      },
    }) =>
      void (surface.show = () => {
        delete surface.show;
        throw new Error('broken on purpose');
      }),
    ({scene: {parts}}) => {
      parts.draw = () => {
        delete parts.draw;
        throw new Error('broken on purpose');
      };
    },
  ]) {
    const viewer = await browser.open(`${server.url}?mesh=box`);
    await viewer.waitForState('complete');
    await viewer.waitForPicture();
    const whole = await viewer.screenshot('broken-not');
    await viewer.inView(breakOnce);
    await viewer.page.evaluate(() => window.qtetViewer.setAttribute('surface', 'off'));
    await viewer.page
      .getByText('Something went wrong while drawing: Uncaught Error: broken on purpose')
      .waitFor();
    await viewer.page.evaluate(() => {
      const viewer = window.qtetViewer;
      viewer.removeAttribute('surface');
      viewer.setAttribute('clip', 'x:0.3');
      viewer.look('-y');
    });
    await viewer.waitInView(
      ({
        scene: {
          parts: {cuts},
        },
      }) => cuts[0].visible,
    );
    await viewer.settle();
    const other = await viewer.screenshot('broken-after');
    assert.ok(
      coloredShare(other) > 0.02 && differingShare(whole, other) > 0.02,
      'no other picture comes',
    );
    assert.ok(await viewer.page.locator('qtet-viewer .notice').isVisible(), 'the notice is gone');
    assert.ok(
      await viewer.page.getByRole('button', {name: 'Try again'}).isVisible(),
      'there is no way out',
    );
  }
}

/** The quality changes before the worker knows any mesh: the new one counts. */
async function heedsAQualityThatChangesBeforeTheHeadHasCome({server, browser, logs}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&quality=cells:1000`, undefined, () => {
    const {postMessage} = Worker.prototype;
    Worker.prototype.postMessage = function (message, ...rest) {
      postMessage.call(this, message, ...rest);
      if (message.type === 'start')
        queueMicrotask(() => window.qtetViewer.removeAttribute('quality'));
    };
  });
  await viewer.waitForState('complete');
  await expectWhole(viewer, logs.fin);
}

/**
 * Another log takes the name in mid-stream: the page starts again, with the places and values of
 * the new one.
 */
async function showsTheLogThatTookTheName({server, browser, logs}) {
  const path = join(logs.fin.folder, 'changing.qtet');
  copyFileSync(join(logs.fin.folder, 'fin.qtet'), path);
  server.kill();
  await server.start();
  const line = await PoorLine.open(server.port, {holdAt: 50000});
  try {
    const viewer = await browser.open(`${line.url}?mesh=changing&clip=x:0.4`);
    await viewer.page.waitForFunction(
      () => window.qtetViewer.statistics.chunks > 2 && window.qtetSeen.pictures > 0,
      null,
      {timeout: kTimeoutMs, polling: 50},
    );
    const {chunks, chunkCount} = await viewer.statistics();
    assert.ok(chunks < chunkCount, 'everything had come before the log was replaced');
    server.kill();
    line.cut();
    copyFileSync(join(logs.box.folder, 'box.qtet'), path);
    await server.start();
    await viewer.waitForState('complete');
    await viewer.page.waitForFunction(
      () => window.qtetSeen.events.some(({type}) => type === 'complete'),
      null,
      {timeout: kTimeoutMs},
    );
    await expectWhole(viewer, logs.box);
    await viewer.settle();
    const again = await browser.open(viewer.page.url());
    await again.waitForState('complete');
    await again.waitForPicture();
    await again.settle();
    const differing = differingShare(
      await again.screenshot('changed-fresh'),
      await viewer.screenshot('changed'),
    );
    assert.ok(differing < 0.005, `${differing} of the picture is another than a fresh page's`);
    const loads = (await viewer.seen()).events.filter(({type}) => type === 'load').length;
    assert.equal(loads, 2);
    return `after ${chunks} of ${chunkCount} chunks`;
  } finally {
    line.close();
    rmSync(path);
  }
}

/**
 * Every attribute change sets all settings. Only those that change the picture may redraw it: that
 * takes graphics without a GPU a fifth of a second.
 */
async function drawsOnlyWhatChanges({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin`);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  await viewer.inView((view) => {
    const {parts} = view.scene;
    const draw = parts.draw.bind(parts);
    view.drawnByCheck = 0;
    parts.draw = (...words) => {
      ++view.drawnByCheck;
      draw(...words);
    };
  });
  const drawnAfter = async (name, value) => {
    const before = await viewer.inView((view) => view.drawnByCheck);
    await viewer.page.evaluate((words) => window.qtetViewer.setAttribute(...words), [name, value]);
    await viewer.settle();
    return (await viewer.inView((view) => view.drawnByCheck)) - before;
  };
  assert.equal(await drawnAfter('quality', 'cells:100000000'), 0);
  assert.ok((await drawnAfter('edges', 'off')) > 0);
  assert.ok((await drawnAfter('projection', 'parallel')) > 0);
}

/**
 * Every control that is touched or reached by Tab must be visible then, and the panel's head must
 * stay in place.
 */
async function showsWhatHasTheFocus({server, browser}) {
  for (const device of [
    {...kPhone, deviceScaleFactor: 1},
    {viewport: {width: 1000, height: 420}},
  ]) {
    const viewer = await browser.open(
      `${server.url}?mesh=box&clip=x&iso=Scalar=0.5&threshold=Scalar=0,1&volume`,
      device,
    );
    await viewer.waitForState('complete');
    await viewer.waitForPicture();
    const {page} = viewer;
    if (device.isMobile) await page.getByRole('button', {name: 'Controls'}).tap();
    for (const text of ['Slice', 'Line', 'Reversed'])
      await page.getByText(text, {exact: true})[device.isMobile ? 'tap' : 'click']();
    const place = () =>
      page.evaluate(() => {
        const {shadowRoot} = window.qtetViewer;
        const focused = shadowRoot.activeElement;
        const panel = shadowRoot.querySelector('.panel');
        const shown = shadowRoot.querySelector('.body').getBoundingClientRect();
        const {top, bottom} = (
          focused?.closest('label') ??
          focused ??
          panel
        ).getBoundingClientRect();
        return {
          name: focused?.name || focused?.className,
          scrolled: panel.scrollTop,
          inPanel: panel.contains(focused),
          inHead: focused?.closest('header, .actions') != null,
          seen: top >= shown.top - 1 && bottom <= shown.bottom + 1,
        };
      });
    assert.equal((await place()).scrolled, 0, 'a touch scrolls the panel away');
    await page.locator('qtet-viewer .fold').focus();
    let tabs = 0;
    for (let now = await place(); now.inPanel; now = await place()) {
      assert.ok(now.scrolled === 0 && (now.inHead || now.seen), JSON.stringify(now));
      await page.keyboard.press('Tab');
      ++tabs;
    }
    assert.ok(tabs > 25, `only ${tabs} stops`);
    assert.deepEqual(viewer.problems, []);
  }
}

export const elementChecks = {
  holdsTheAddressFromTheFirstPictureOn,
  showsWhatHasTheFocus,
  drawsOnlyWhatChanges,
  showsNothingOfTheMeshBefore,
  tellsOfTheWholeMeshOnceItIsDrawn,
  tellsTheNewestFiguresWithAnOldPicture,
  takesItsAttributesInTheTaskThatAppendsIt,
  pausesInTheTaskThatAppendsIt,
  keepsWhatIsAskedForBeforeThereIsAMesh,
  leavesNothingBehind,
  keepsCameraAndMeshWhereverItMoves,
  drawsOnAfterAPictureThatFailed,
  heedsAQualityThatChangesBeforeTheHeadHasCome,
  showsTheLogThatTookTheName,
};
