import {describe, expect, test} from 'vitest';
import type {Packet} from '../core/packet';
import {boundsOfMarks, marksOf, meets} from '../core/marks';
import {inOrder, kNoWishes, wireView} from '../core/wishes';

const kSize = 65536;
/** A triangle in the middle of the 8th 16th along each axis. */
const kAt = (7.5 / 16) * kSize;
const marks = marksOf(new Float32Array(9).fill(kAt), kSize)!;
const box = (from: number, to: number): number[] => [from, from, from, to, to, to];

describe('marks', () => {
  test('reachOneBoxBeyondWhatTheyAreMadeOf', () => {
    expect([...marks].filter((mark) => mark === 1)).toHaveLength(27);
    expect(boundsOfMarks(marks)).toEqual([6, 6, 6, 9, 9, 9].map((x) => x / 16));
    expect([
      meets(marks, box(0, 95)),
      meets(marks, box(0, 96)),
      meets(marks, box(143, 200)),
      meets(marks, box(144, 200)),
    ]).toEqual([false, true, true, false]);
  });

  test('atTheLatticesEdgesStayInside', () => {
    expect(
      boundsOfMarks(marksOf(Float32Array.from([0, 0, 0, kSize - 1, 0, 0, 0, 0, 0]), kSize)!),
    ).toEqual([0, 0, 0, 1, 2 / 16, 2 / 16]);
    expect(marksOf(new Float32Array(0), kSize)).toBeNull();
  });

  test('bringTheirPacketsFirstParentsBeforeChildren', () => {
    const packets: Packet[] = [
      {chunk: 1, depth: 0, box: box(0, 255)},
      {chunk: 2, depth: 1, box: box(0, 90)},
      {chunk: 3, depth: 1, box: box(91, 255)},
      {chunk: 4, depth: 2, box: box(91, 120)},
    ];
    expect(inOrder(packets, {...kNoWishes, marks}, kSize).map(({chunk}) => chunk)).toEqual([
      1, 3, 4, 2,
    ]);
    // A plane where they are not: either will do.
    const plane = {normal: [1, 0, 0] as [number, number, number], offset: 10};
    expect(
      inOrder(packets, {...kNoWishes, marks, planes: [plane]}, kSize).map(({chunk}) => chunk),
    ).toEqual([1, 2, 3, 4]);
  });

  test('areOneBoxToAServer', () => {
    expect(wireView({...kNoWishes, marks}, {origin: [1, 2, 3], step: 0.5, size: 32})).toEqual({
      box: [7, 8, 9, 10, 11, 12],
    });
  });
});
