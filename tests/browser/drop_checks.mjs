// Files of the visitor's own that are dropped on the page: logs, and meshes, which the page
// simplifies. No server gets them.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {readdirSync, readFileSync, statSync} from 'node:fs';
import {basename, join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {kDesktop} from './browser.mjs';
import {expectWhole} from './expect.mjs';

/** A viewer that shows a mesh of the server, and what it asks for from now on. */
async function withMesh({server, browser}) {
  const viewer = await browser.open(`${server.url}?mesh=fin&field=Pressure`);
  await viewer.waitForState('complete');
  const sent = [];
  viewer.page.on('request', (request) => sent.push(request));
  const staysHere = () => {
    for (const request of sent) {
      const url = request.url();
      assert.equal(request.method(), 'GET', url);
      assert.ok(/^blob:|\/assets\/[^?]*$/.test(url), `${url} is asked for`);
    }
  };
  return {viewer, staysHere};
}

/** `files`: [name, bytes], dropped together. */
export const drop = (viewer, ...files) =>
  viewer.page.evaluate(
    (list) => {
      const dataTransfer = new DataTransfer();
      for (const [name, base64] of list) {
        const content = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
        dataTransfer.items.add(new File([content], name));
      }
      const event = {dataTransfer, bubbles: true, cancelable: true};
      window.qtetViewer.dispatchEvent(new DragEvent('drop', event));
    },
    files.map(([name, bytes]) => [name, bytes.toString('base64')]),
  );

const dropFile = (viewer, path) => drop(viewer, [basename(path), readFileSync(path)]);

/** The bytes of the log that is shown from memory. */
async function shownLog(viewer) {
  const numbers = await viewer.page.evaluate(async () => {
    const address = window.qtetViewer.getAttribute('src').replace(/#.*/, '');
    return [...new Uint8Array(await (await fetch(address)).arrayBuffer())];
  });
  return Buffer.from(numbers);
}

async function notice(viewer) {
  const alert = viewer.page.getByRole('alert');
  await alert.waitFor();
  return alert.innerText();
}

async function showsALogThatIsDropped(context) {
  const {logs} = context;
  const {viewer, staysHere} = await withMesh(context);
  await drop(viewer, ['my box.qtet', readFileSync(join(logs.box.folder, 'box.qtet'))]);
  await viewer.page.waitForFunction(() => window.qtetViewer.statistics.total.tetrahedra === 3072);
  await viewer.waitForState('complete');
  await expectWhole(viewer, logs.box);
  assert.equal(await viewer.page.locator('qtet-viewer h1').innerText(), 'my box');
  staysHere();
  await drop(viewer, ['other.qtet', Buffer.from('no log at all, and far too short')]);
  assert.match(await notice(viewer), /other\.qtet is no log/);
  await expectWhole(viewer, logs.box);
}

/** Whether the viewer was built with what simplifies meshes. */
const canSimplify = (viewer) =>
  readdirSync(join(viewer, 'assets')).some(
    (name) => /^qtet-simplify.*wasm$/.test(name) && statSync(join(viewer, 'assets', name)).size > 0,
  );
const kSkipped = "skipped: the build left the browser's simplifier out";

/** The tool's own bytes, of a file that names none and of one whose pieces come along. */
async function simplifiesAMeshThatIsDropped(context) {
  if (!canSimplify(context.viewer)) return kSkipped;
  const {logs, out, bin} = context;
  const {viewer, staysHere} = await withMesh(context);
  await dropFile(viewer, join(out, 'box.vtu'));
  await viewer.page.waitForFunction(() => window.qtetViewer.statistics.total.tetrahedra === 3072);
  await viewer.waitForState('complete');
  await expectWhole(viewer, logs.box);
  assert.ok((await shownLog(viewer)).equals(readFileSync(join(logs.box.folder, 'box.qtet'))));
  assert.equal(await viewer.page.locator('qtet-viewer h1').innerText(), 'box');

  const msh = join(out, 'tool.msh');
  const tool = (...words) => execFileSync(join(bin, 'qtet'), words, {encoding: 'utf8'});
  tool('convert', join(out, 'fin.vtu'), '-o', msh);
  const byTool = JSON.parse(tool('simplify', msh, '-o', join(out, 'tool.qtet'), '--json'));
  const start = Date.now();
  await dropFile(viewer, msh);
  await viewer.page.getByText('stays on this machine').waitFor();
  await viewer.screenshot('dropped_mesh');
  await viewer.page.waitForFunction(() => window.qtetViewer.statistics.total.tetrahedra > 3072);
  const seconds = (Date.now() - start) / 1000;
  assert.ok((await shownLog(viewer)).equals(readFileSync(join(out, 'tool.qtet'))));
  staysHere();
  return `fin in ${seconds.toFixed(1)} s, by the tool in ${byTool.seconds.total.toFixed(1)} s`;
}

/** The file that a button of the section File saves; its path. */
async function saved({viewer, out}, button, name) {
  const {page} = viewer;
  const summary = page.getByText('File', {exact: true});
  if (!(await page.getByRole('button', {name: button}).isVisible())) await summary.click();
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', {name: button}).click(),
  ]);
  const path = join(out, name);
  await download.saveAs(path);
  return path;
}

/** On a page from the disk as well, which takes another log then. */
async function savesTheLogAndAPageOfIt(context) {
  const {logs, out, browser} = context;
  const {viewer} = await withMesh(context);
  const log = await saved({viewer, out}, 'Save log', 'saved.qtet');
  assert.ok(readFileSync(log).equals(readFileSync(join(logs.fin.folder, 'fin.qtet'))));
  const path = await saved({viewer, out}, 'Save page', 'saved.html');
  const other = await browser.open(pathToFileURL(path).href, {...kDesktop, offline: true});
  await other.waitForState('complete');
  await expectWhole(other, logs.fin);
  assert.equal(await other.page.locator('qtet-viewer').getAttribute('field'), 'Pressure');
  await drop(other, ['box.qtet', readFileSync(join(logs.box.folder, 'box.qtet'))]);
  await other.page.waitForFunction(() => window.qtetViewer.statistics.total.tetrahedra === 3072);
  await other.waitForState('complete');
  await expectWhole(other, logs.box);
  const again = await saved({viewer: other, out}, 'Save log', 'again.qtet');
  assert.ok(readFileSync(again).equals(readFileSync(join(logs.box.folder, 'box.qtet'))));
  await dropFile(other, join(out, 'box.vtu'));
  assert.match(await notice(other), /What simplifies meshes cannot be loaded/);
  return `the page has ${statSync(path).size} bytes`;
}

async function givesUpADroppedMesh(context) {
  if (!canSimplify(context.viewer)) return kSkipped;
  const {logs, out} = context;
  const {viewer} = await withMesh(context);
  await dropFile(viewer, join(out, 'fin.vtu'));
  await viewer.page.getByText('stays on this machine').waitFor();
  await viewer.page.getByRole('button', {name: 'Cancel'}).click();
  await viewer.page.getByText('stays on this machine').waitFor({state: 'hidden'});
  await expectWhole(viewer, logs.fin);

  const mesh = readFileSync(join(out, 'box.vtu'));
  for (const [name, bytes, sentence] of [
    ['cut.vtu', mesh.subarray(0, mesh.length / 2), /^cut\.vtu ends without/],
    ['plain.txt', Buffer.from('no mesh at all'), /^plain\.txt: qtet reads this format neither/],
    [
      'wing.cgns',
      Buffer.from('\x89HDF and more'),
      /neither in browsers nor in node.*qtet simplify/s,
    ],
    ['empty.vtu', Buffer.alloc(0), /^empty\.vtu is empty/],
  ]) {
    await drop(viewer, [name, bytes]);
    assert.match(await notice(viewer), sentence);
    await viewer.page.getByRole('button', {name: 'Close'}).click();
  }
  await expectWhole(viewer, logs.fin);
}

/** Whatever does not become a picture is named. */
async function namesWhatIsNotShown(context) {
  const {logs, out, viewer: files} = context;
  const {viewer} = await withMesh(context);
  const close = () => viewer.page.getByRole('button', {name: 'Close'}).click();
  const pieces = Buffer.from(
    '<VTKFile type="PUnstructuredGrid"><PUnstructuredGrid><PPoints>' +
      '<PDataArray type="Float32" Name="Points" NumberOfComponents="3"/></PPoints>' +
      '<Piece Source="a/a_0.vtu"/></PUnstructuredGrid></VTKFile>',
  );
  await drop(viewer, ['a.pvtu', pieces]);
  assert.match(await notice(viewer), /^a\.pvtu needs a_0\.vtu, which it names\./);
  await viewer.screenshot('dropped-pvtu');
  await close();
  await drop(viewer, ['part.stl', Buffer.from('solid part')]);
  assert.match(await notice(viewer), /^part\.stl is a surface: it has no cells inside/);
  await viewer.screenshot('dropped-stl');
  await close();
  await expectWhole(viewer, logs.fin);

  const box = readFileSync(join(logs.box.folder, 'box.qtet'));
  await drop(viewer, ['one.qtet', box], ['other.qtet', box]);
  assert.match(await notice(viewer), /^other\.qtet is not shown beside one\.qtet/);
  await viewer.waitForState('complete');
  await expectWhole(viewer, logs.box);
  assert.match(await notice(viewer), /^other\.qtet is not shown/);
  await viewer.screenshot('dropped-two');
  if (!canSimplify(files)) return kSkipped;
  await close();
  const mesh = readFileSync(join(out, 'box.vtu'));
  await drop(viewer, ['first.vtu', mesh], ['second.vtu', mesh]);
  await viewer.page.waitForFunction(
    () => window.qtetViewer.shadowRoot.querySelector('h1').innerText === 'first',
  );
  assert.match(await notice(viewer), /^second\.vtu is not shown beside first\.vtu/);
  await viewer.waitForState('complete');
  await expectWhole(viewer, logs.box);
  await close();
  await drop(viewer, ['a_0.vtu', mesh], ['a.pvtu', pieces]);
  await viewer.page.waitForFunction(
    () => window.qtetViewer.shadowRoot.querySelector('h1').innerText === 'a',
  );
  await viewer.waitForState('complete');
  assert.equal((await viewer.counts()).tetrahedra, 3072);
}

export const dropChecks = {
  namesWhatIsNotShown,
  showsALogThatIsDropped,
  simplifiesAMeshThatIsDropped,
  savesTheLogAndAPageOfIt,
  givesUpADroppedMesh,
};
