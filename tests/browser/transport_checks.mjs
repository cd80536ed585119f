// The ways a log can take into the page, each by itself and one after the other.

import assert from 'node:assert/strict';
import {join} from 'node:path';
import {kDesktop} from './browser.mjs';
import {expectWhole} from './expect.mjs';
import {PoorLine} from './poor_line.mjs';
import {makeLog} from './programs.mjs';
import {hostFolder, makeSite} from './static_host.mjs';

async function readsALogFromAPlainWebServer({browser, logs, viewer: files, out}) {
  const folder = makeSite(join(out, 'site'), files, logs.fin);
  const notes = [];
  for (const options of [{}, {nginx: false}, {ranges: false}]) {
    const host = await hostFolder(folder, options);
    try {
      const viewer = await browser.open(`${host.url}?src=fin.qtet&colormap=cividis`, {...kDesktop, colorScheme: notes.length === 0 ? 'dark' : 'light'});
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

async function takesRangesAndChunksFromAServer({server, browser, logs}) {
  for (const kind of ['range', 'chunks']) {
    const viewer = await browser.open(`${server.url}?mesh=fin&transport=${kind}`);
    await viewer.waitForState('complete');
    await expectWhole(viewer, logs.fin);
    const fetched = await viewer.page.evaluate(() => performance.getEntriesByType('resource').map(({name}) => name));
    assert.ok(!fetched.some((name) => name.includes('/v1/stream')), 'a WebSocket was opened');
  }
}

async function goesOnOverHttpWhereTheSocketIsBlocked({server, browser, logs}) {
  const line = await PoorLine.open(server.port, {bytesPerSecond: 60000, streamsOnly: true});
  try {
    const viewer = await browser.open(`${line.url}?mesh=fin`);
    await viewer.page.waitForFunction(() => window.qtetViewer.statistics.chunks > 2, null, {polling: 50});
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

/** A log of regions refines where it is cut before it refines elsewhere; whatever the order, it ends as the same mesh. */
async function refinesWhatIsLookedAtFirst({server, browser, out, bin}) {
  const log = makeLog(bin, 'regions', out, 'fin', ['--layout', 'regions', '--cells-per-packet', '1500']);
  server.kill();
  await server.start();
  const shares = async (query) => {
    const viewer = await browser.open(`${server.url}?mesh=regions&${query}`);
    const now = () => viewer.page.evaluate(() => ({cut: window.qtetViewer.snapshot.cuts[0].positions.length, cells: window.qtetViewer.statistics.tetrahedra}));
    await viewer.waitForState('held');
    await viewer.waitForPicture();
    await viewer.settle();  // the picture has told where the mesh is, and so where the plane lies in it
    await viewer.page.evaluate(() => window.qtetViewer.setAttribute('quality', 'cells:100000'));
    await viewer.page.waitForFunction(() => window.qtetViewer.state === 'held' && window.qtetViewer.statistics.tetrahedra >= 100000, null, {polling: 50});
    await viewer.settle();
    const held = await now();
    await viewer.screenshot('regions-held');
    await viewer.page.getByRole('button', {name: 'Continue'}).click();
    await viewer.waitForState('complete');
    await viewer.settle();
    await expectWhole(viewer, log);
    const whole = await now();
    return {cut: held.cut / whole.cut, cells: held.cells / whole.cells};
  };
  const {cut, cells} = await shares('transport=range&clip=x:0.8&quality=cells:30000');
  assert.ok(cut > 0.9 && cells < 0.6, `the cut has ${cut} of its cells when the mesh has ${cells}`);
  const viewer = await browser.open(`${server.url}?mesh=regions&clip=y:0.3`);
  await viewer.waitForState('complete');
  await expectWhole(viewer, log);
  return `${Math.round(100 * cut)} % of the cut is there with ${Math.round(100 * cells)} % of the cells`;
}

export const transportChecks = {
  refinesWhatIsLookedAtFirst,
  readsALogFromAPlainWebServer, saysThatAFileIsMissing, takesRangesAndChunksFromAServer, goesOnOverHttpWhereTheSocketIsBlocked,
};
