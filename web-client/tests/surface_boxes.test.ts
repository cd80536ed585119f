import {describe, expect, test} from 'vitest';
import type {Packet} from '../core/protocol/packet';
import {boundsOfBoxes, surfaceBoxesOf, meets} from '../core/protocol/surface_boxes';
import {inOrder, kNoViewRequest, wireView} from '../core/protocol/view_request';

const kSize = 65536;
/** A triangle in the middle of the 8th 16th along each axis. */
const kAt = (7.5 / 16) * kSize;
const surfaceBoxes = surfaceBoxesOf(new Float32Array(9).fill(kAt), kSize)!;
const box = (from: number, to: number): number[] => [from, from, from, to, to, to];

describe('the boxes of a surface', () => {
  test('reachOneBoxBeyondWhatTheyAreMadeOf', () => {
    expect([...surfaceBoxes].filter((inside) => inside === 1)).toHaveLength(27);
    expect(boundsOfBoxes(surfaceBoxes)).toEqual([6, 6, 6, 9, 9, 9].map((x) => x / 16));
    expect([
      meets(surfaceBoxes, box(0, 95)),
      meets(surfaceBoxes, box(0, 96)),
      meets(surfaceBoxes, box(143, 200)),
      meets(surfaceBoxes, box(144, 200)),
    ]).toEqual([false, true, true, false]);
  });

  test('atTheLatticesEdgesStayInside', () => {
    expect(
      boundsOfBoxes(surfaceBoxesOf(Float32Array.from([0, 0, 0, kSize - 1, 0, 0, 0, 0, 0]), kSize)!),
    ).toEqual([0, 0, 0, 1, 2 / 16, 2 / 16]);
    expect(surfaceBoxesOf(new Float32Array(0), kSize)).toBeNull();
  });

  test('bringTheirPacketsFirstParentsBeforeChildren', () => {
    const packets: Packet[] = [
      {chunk: 1, depth: 0, box: box(0, 255)},
      {chunk: 2, depth: 1, box: box(0, 90)},
      {chunk: 3, depth: 1, box: box(91, 255)},
      {chunk: 4, depth: 2, box: box(91, 120)},
    ];
    expect(
      inOrder(packets, {...kNoViewRequest, surfaceBoxes}, kSize).map(({chunk}) => chunk),
    ).toEqual([1, 3, 4, 2]);
    // A plane elsewhere: a packet may meet either.
    const plane = {normal: [1, 0, 0] as [number, number, number], offset: 10};
    expect(
      inOrder(packets, {...kNoViewRequest, surfaceBoxes, planes: [plane]}, kSize).map(
        ({chunk}) => chunk,
      ),
    ).toEqual([1, 2, 3, 4]);
  });

  test('areOneBoxToAServer', () => {
    expect(
      wireView({...kNoViewRequest, surfaceBoxes}, {origin: [1, 2, 3], step: 0.5, size: 32}),
    ).toEqual({
      box: [7, 8, 9, 10, 11, 12],
    });
  });
});
