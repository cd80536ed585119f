// The expectations of every check of a complete mesh.

import assert from 'node:assert/strict';

export async function expectWhole(viewer, log) {
  // The figures belong to the last picture, which comes a moment after the last byte.
  await viewer.page.waitForFunction(() => {
    const {tetrahedra, total} = window.qtetViewer.statistics;
    return tetrahedra === total.tetrahedra;
  });
  const {tetrahedra, total, bytes, bytesNeeded} = await viewer.statistics();
  assert.equal(tetrahedra, total.tetrahedra);
  assert.equal(bytes, bytesNeeded);
  assert.equal(await viewer.digest(), log.meshDigest);
  assert.deepEqual(viewer.problems, []);
}
