// The camera and its controls beside those of three.js, which are tested elsewhere.

import {PerspectiveCamera, Vector3} from 'three';
import {OrbitControls as TheirControls} from 'three/addons/controls/OrbitControls.js';
import {beforeEach, describe, expect, test} from 'vitest';
import {OrbitCamera} from '../webgl/camera';
import {inverse, product, transformed} from '../webgl/matrix';
import {OrbitControls} from '../webgl/orbit_controls';
import {WorkerCanvas, type CanvasEvent} from '../webgl/worker_canvas';

const kWidth = 800;
const kHeight = 500;

/** A canvas for both: theirs asks for more of an element. */
class TheirCanvas extends WorkerCanvas {
  getRootNode(): this {
    return this;
  }
  releasePointerCapture(): void {
    return;
  }
}

const kRest: CanvasEvent = {
  ...{type: '', clientX: 0, clientY: 0, pageX: 0, pageY: 0, button: 0, pointerId: 1},
  ...{pointerType: 'mouse', deltaY: 0, deltaMode: 0, key: ''},
  ...{ctrlKey: false, metaKey: false, shiftKey: false},
};

let ours: OrbitCamera;
let theirs: PerspectiveCamera;
let theirTarget: Vector3;
let canvases: WorkerCanvas[];
let changes: number;

beforeEach(() => {
  changes = 0;
  canvases = [new WorkerCanvas({} as OffscreenCanvas), new TheirCanvas({} as OffscreenCanvas)];
  for (const canvas of canvases) canvas.resize({width: kWidth, height: kHeight, pixelRatio: 1});
  ours = new OrbitCamera();
  new OrbitControls(ours, canvases[0]!, () => ++changes);
  const part = {fullWidth: kWidth, fullHeight: kHeight, x: 90, y: -20};
  ours.lens.setPart({...part, width: kWidth, height: kHeight});
  theirs = new PerspectiveCamera(ours.lens.degrees, 1, 0.01, 100);
  theirs.up.set(0, 0, 1);
  theirs.position.set(...ours.lens.eye);
  theirs.setViewOffset(kWidth, kHeight, part.x, part.y, kWidth, kHeight);
  const controls = new TheirControls(theirs, canvases[1] as unknown as HTMLCanvasElement);
  controls.zoomToCursor = true;
  theirTarget = controls.target;
});

/** Theirs expects that a frame was drawn before. */
function send(event: Partial<CanvasEvent>): void {
  theirs.updateMatrixWorld();
  const place = {pageX: event.clientX ?? 0, pageY: event.clientY ?? 0};
  for (const canvas of canvases) canvas.receive({...kRest, ...place, ...event});
}

function drag(from: number[], to: number[], others: Partial<CanvasEvent> = {}): void {
  for (const [type, [clientX, clientY]] of [
    ['pointerdown', from],
    ['pointermove', from.map((start, i) => (start + to[i]!) / 2)],
    ['pointermove', to],
    ['pointerup', to],
  ] as [string, [number, number]][])
    send({...others, type, clientX, clientY});
}

function expectTheSame(): void {
  ours.setDepths();
  Object.assign(theirs, {near: ours.lens.near, far: ours.lens.far});
  theirs.updateProjectionMatrix();
  theirs.updateMatrixWorld();
  const {toEye, toCube, eye} = ours.lens;
  const closeTo = (mine: readonly number[], its: readonly number[]): void =>
    mine.forEach((value, i) => expect(value).toBeCloseTo(its[i]!, 6));
  closeTo(eye, theirs.position.toArray());
  closeTo(ours.target, theirTarget.toArray());
  closeTo(toEye, theirs.matrixWorldInverse.toArray());
  closeTo(toCube, theirs.projectionMatrix.toArray());
  const point = new Vector3(0.2, -0.4, 0.3);
  const seen = transformed(product(toCube, toEye), point.toArray());
  closeTo(seen, point.project(theirs).toArray());
}

describe('pointers move the camera as those of three do', () => {
  test('turning, up to straight above', () => {
    drag([400, 250], [470, 260]);
    expectTheSame();
    expect(ours.fitted).toBe(false);
    drag([400, 100], [420, 480]);
    expectTheSame();
  });

  test('moving by the right button, or with a key', () => {
    drag([400, 250], [430, 200], {button: 2});
    expectTheSame();
    drag([400, 250], [410, 300], {shiftKey: true});
    expectTheSame();
    drag([400, 250], [410, 300], {button: 2, ctrlKey: true});
    expectTheSame();
  });

  test('zooming at the pointer, by wheels of all units and by the middle button', () => {
    for (const [deltaY, deltaMode] of [
      [-120, 0],
      [3, 1],
      [-1, 2],
    ] as const)
      send({type: 'wheel', clientX: 200, clientY: 380, deltaY, deltaMode});
    expectTheSame();
    drag([500, 300], [500, 340], {button: 1});
    expectTheSame();
  });

  test('a pinch of a touchpad, and a wheel with Control', () => {
    send({type: 'wheel', clientX: 500, clientY: 100, deltaY: -4, ctrlKey: true});
    expectTheSame();
    send({type: 'keydown', key: 'Control'});
    send({type: 'wheel', clientX: 500, clientY: 100, deltaY: -100, ctrlKey: true});
    send({type: 'keyup', key: 'Control'});
    expectTheSame();
  });

  test('one finger, two fingers, and one again', () => {
    const touch = {pointerType: 'touch', pointerId: 1};
    const other = {pointerType: 'touch', pointerId: 2};
    send({...touch, type: 'pointerdown', clientX: 300, clientY: 200});
    send({...touch, type: 'pointermove', clientX: 320, clientY: 230});
    send({...other, type: 'pointerdown', clientX: 500, clientY: 300});
    send({...other, type: 'pointermove', clientX: 540, clientY: 290});
    send({...touch, type: 'pointermove', clientX: 280, clientY: 240});
    send({...other, type: 'pointerup', clientX: 540, clientY: 290});
    send({...touch, type: 'pointermove', clientX: 260, clientY: 220});
    send({...touch, type: 'pointerup', clientX: 260, clientY: 220});
    expectTheSame();
  });
});

test('aTapMovesNothing', () => {
  send({type: 'pointerdown', clientX: 300, clientY: 200});
  send({type: 'pointermove', clientX: 300, clientY: 200});
  send({type: 'pointerup', clientX: 300, clientY: 200});
  send({type: 'wheel', deltaY: 0});
  expect([ours.fitted, changes]).toEqual([true, 0]);
});

test('anInverseUndoes', () => {
  ours.orbit(0.3, 0.2);
  const {toEye, toCube} = ours.lens;
  const both = product(toCube, toEye);
  product(inverse(both), both).forEach((value, i) => expect(value).toBeCloseTo(i % 5 ? 0 : 1, 9));
  expect(inverse(new Array<number>(16).fill(1))).toEqual(new Array<number>(16).fill(0));
});
