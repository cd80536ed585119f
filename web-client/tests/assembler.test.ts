import {beforeEach, describe, expect, test} from 'vitest';
import {Assembler} from '../core/decode/assembler';
import {parseFrame} from '../core/protocol/messages';
import {FakeCodec, fieldFrame, headFrame, kFakeValues, meshFrame, type FakeLog} from './fakes';

const kLog: FakeLog = {fields: ['p'], chunks: 4};

let codec: FakeCodec;
let assembler: Assembler;

beforeEach(() => {
  codec = new FakeCodec(kLog);
  assembler = new Assembler(codec, kFakeValues);
  assembler.take(parseFrame(headFrame(1, kLog)));
});

/** Decodes all that it can; gives how many chunks the mesh and the field then have. */
function decoded(mesh: number[], field: number[]): [number, number] {
  for (const chunk of mesh) assembler.take(parseFrame(meshFrame(1, chunk)));
  for (const chunk of field) assembler.take(parseFrame(fieldFrame(1, chunk, 0)));
  while (assembler.step([0], true)) continue;
  return [codec.chunksApplied, codec.fieldChunksApplied(0)];
}

describe('what is here', () => {
  test('isDecodedInTheFilesOrderHoweverItArrives', () => {
    expect(decoded([2, 1, 0, 3], [3, 2, 1, 0])).toEqual([4, 4]);
  });

  test('waitsForTheChunkBeforeIt', () => {
    expect(decoded([0, 2, 3], [0, 1, 3])).toEqual([1, 1]);
    expect(decoded([1], [])).toEqual([4, 2]);
    expect(decoded([], [2])).toEqual([4, 4]);
  });
});

test('aFieldWaitsForThoseThatItIsPredictedFrom', () => {
  codec = new FakeCodec({fields: ['a', 'b', 'c'], chunks: 2});
  codec.parentsOf = [[], [0], [1]];
  assembler = new Assembler(codec, kFakeValues);
  assembler.take(parseFrame(headFrame(1, {fields: ['a', 'b', 'c'], chunks: 2})));
  const fields = [2];
  expect(assembler.parents.order(fields)).toEqual([0, 1, 2]);
  expect(assembler.parents.order(fields)).toBe(assembler.parents.order(fields));
  const step = (): number[] => {
    while (assembler.step([2], true)) continue;
    return [0, 1, 2].map((field) => codec.fieldChunksApplied(field));
  };
  for (const chunk of [0, 1]) assembler.take(parseFrame(meshFrame(1, chunk)));
  assembler.take(parseFrame(fieldFrame(1, 0, 2)));
  expect(step()).toEqual([0, 0, 0]);
  assembler.take(parseFrame(fieldFrame(1, 0, 1)));
  assembler.take(parseFrame(fieldFrame(1, 0, 0)));
  expect(step()).toEqual([1, 1, 1]);
  for (const field of [1, 0, 2]) assembler.take(parseFrame(fieldFrame(1, 1, field)));
  expect(step()).toEqual([2, 2, 2]);
  expect(assembler.wholeFields).toEqual([0, 1, 2]);
  assembler.forget();
  expect([assembler.wholeFields, assembler.parents.order(fields)]).toEqual([[], [2]]);
});

test('thePlanTellsOfEachChunkWithItsBytesAndItsLevel', () => {
  const seen = [];
  for (let chunk = 0; chunk < kLog.chunks; ++chunk) {
    decoded([chunk], [chunk]);
    const {bytes, level} = assembler.statistics([0]);
    seen.push({bytes, level});
  }
  expect(assembler.plan([0])).toEqual(seen);
});
