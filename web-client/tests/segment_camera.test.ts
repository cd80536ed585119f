// The camera while one segment follows another: each log has a lattice of its own.

import {expect, test} from 'vitest';
import {latticeChange, moved, positionOf, type Vector} from '../core/protocol/geometry';
import {MeshCamera} from '../webgl/mesh_camera';
import {project} from '../webgl/pose';
import {WorkerCanvas} from '../webgl/worker_canvas';

const kSize = {clientWidth: 1280, clientHeight: 800};
const kCoarse = {origin: [-1, 2, 0] as Vector, step: 0.5};
const kFine = {origin: [3, -7, 1] as Vector, step: 0.125};
const change = latticeChange(kCoarse, kFine);

function camera(): MeshCamera {
  const canvas = new WorkerCanvas({} as OffscreenCanvas);
  canvas.resize({width: kSize.clientWidth, height: kSize.clientHeight, pixelRatio: 1});
  const made = new MeshCamera(canvas, () => undefined);
  made.resize(kSize.clientWidth, kSize.clientHeight);
  made.growTo({bounds: [0, 0, 0, 200, 100, 50]});
  return made;
}

test('aPlaceStaysWhereItIsOnTheOtherLattice', () => {
  const place: Vector = [17, 4, 9];
  expect(positionOf(kFine, moved(change, place))).toEqual(positionOf(kCoarse, place));
});

test.each([false, true])('theSamePlaceIsSeenAtTheSamePixel', (isMoved) => {
  const its = camera();
  if (isMoved) its.moveTo([1, -3, 2, 0.1, 0, 0]);
  const before = project(its.pose(0), kSize, [200, 0, 50]);
  const {camera: state, fitted} = its.pose(0);
  its.changeLattice(change);
  const corners = [...moved(change, [0, 0, 0]), ...moved(change, [200, 100, 50])];
  its.growTo({bounds: corners});
  const after = project(its.pose(0), kSize, moved(change, [200, 0, 50]));
  expect(after.x).toBeCloseTo(before.x, 6);
  expect(after.y).toBeCloseTo(before.y, 6);
  expect(its.pose(0).camera).toEqual(state);
  expect(its.pose(0).fitted).toBe(fitted);
});

test('aMovedCameraStaysInPlaceBesideALargerSegment', () => {
  const its = camera();
  its.moveTo([1, -3, 2, 0.1, 0, 0]);
  const before = project(its.pose(0), kSize, [200, 0, 50]);
  its.changeLattice(change);
  its.growTo({bounds: [...moved(change, [0, 0, 0]), ...moved(change, [700, 100, 50])]});
  const after = project(its.pose(0), kSize, moved(change, [200, 0, 50]));
  expect(after.x).toBeCloseTo(before.x, 6);
  expect(after.y).toBeCloseTo(before.y, 6);
  expect(its.pose(0).fitted).toBe(false);
});

test('aCameraWithoutAMeshWaitsForOne', () => {
  const its = camera();
  its.clear();
  its.changeLattice(change);
  expect(its.hasMesh).toBe(false);
});
