import {beforeEach, describe, expect, test} from 'vitest';
import {Assembler} from '../core/decode/assembler';
import {parseFrame} from '../core/protocol/messages';
import {kNoViewRequest} from '../core/protocol/view_request';
import {FakeCodec, fieldFrame, headFrame, kFakeValues, meshFrame, type FakeLog} from './fakes';

const kLog: FakeLog = {fields: ['p'], chunks: 6};
const kHeadChunks = 2;

/** Two chunks of the head; packets 2 to the left and 3 to the right, 4 within 2, 5 within 3. */
class PacketCodec extends FakeCodec {
  readonly order: number[] = [];
  override get headChunks(): number {
    return kHeadChunks;
  }
  override dependency(chunk: number): number {
    return chunk < 4 ? Math.min(chunk, kHeadChunks) - 1 : chunk - 2;
  }
  override packetBox(chunk = 0): number[] {
    const left = chunk % 2 === 0 ? 0 : 128;
    return [left, 0, 0, left + 127, 255, 255];
  }
  override apply(chunk: number): void {
    this.order.push(chunk);
    ++this.chunksApplied;
  }
  override applied(chunk = 0): boolean {
    return this.order.includes(chunk);
  }
  readonly fieldOrder: number[] = [];
  override applyField(_: number, chunk: number): void {
    this.fieldOrder.push(chunk);
  }
  override fieldChunksApplied(): number {
    return this.fieldOrder.length;
  }
  override fieldApplied(_: number, chunk: number): boolean {
    return this.fieldOrder.includes(chunk);
  }
}

let codec: PacketCodec;
let assembler: Assembler;

beforeEach(() => {
  codec = new PacketCodec(kLog);
  assembler = new Assembler(codec, kFakeValues);
  assembler.take(parseFrame(headFrame(1, kLog)));
});

function decoded(arriving: number[]): number[] {
  for (const chunk of arriving) assembler.take(parseFrame(meshFrame(1, chunk)));
  while (assembler.step([], true)) continue;
  return codec.order;
}

describe('what is here', () => {
  test('isDecodedHeadFirstThenCoarseBeforeFineHoweverItArrives', () => {
    expect(decoded([4, 5, 3, 1, 2, 0])).toEqual([0, 1, 2, 3, 4, 5]);
  });

  test('isDecodedInTheOrderOfTheViewRequest', () => {
    const right = assembler.lattice!.size - 1;
    assembler.look({...kNoViewRequest, planes: [{normal: [1, 0, 0], offset: right}]});
    expect(decoded([0, 1, 3, 2, 5, 4])).toEqual([0, 1, 3, 5, 2, 4]);
  });

  test('waitsForTheChunkThatItDependsOn', () => {
    expect(decoded([0, 1, 4, 5])).toEqual([0, 1]);
    expect(decoded([3])).toEqual([0, 1, 3, 5]);
  });

  test('ofAFieldWaitsForItsOwnBlockOfTheParent', () => {
    const fieldOrder = (arriving: number[]): number[] => {
      for (const chunk of arriving) assembler.take(parseFrame(fieldFrame(1, chunk, 0)));
      while (assembler.step([0], true)) continue;
      return codec.fieldOrder;
    };
    expect(decoded([0, 1, 2, 3, 4, 5])).toEqual([0, 1, 2, 3, 4, 5]);
    expect(fieldOrder([0, 4, 5])).toEqual([0]);
    expect(fieldOrder([1])).toEqual([0, 1]); // 2 and 3 are missing
    expect(fieldOrder([3])).toEqual([0, 1, 3, 5]);
    expect(fieldOrder([2])).toEqual([0, 1, 3, 5, 2, 4]);
  });
});

/** Counts the questions about what is applied: each is a call into the codec. */
class CountingCodec extends PacketCodec {
  questions = 0;
  private readonly done = new Set<number>();
  private readonly valuesDone = new Set<number>();
  override dependency(chunk: number): number {
    ++this.questions;
    return chunk < kHeadChunks ? chunk - 1 : Math.max(kHeadChunks - 1, chunk >> 1);
  }
  override apply(chunk: number): void {
    this.done.add(chunk);
    ++this.chunksApplied;
  }
  override applied(chunk = 0): boolean {
    ++this.questions;
    return this.done.has(chunk);
  }
  override applyField(_: number, chunk: number): void {
    this.valuesDone.add(chunk);
  }
  override fieldChunksApplied(): number {
    return this.valuesDone.size;
  }
  override fieldApplied(_: number, chunk: number): boolean {
    ++this.questions;
    return this.valuesDone.has(chunk);
  }
}

describe('the work for a log', () => {
  /** Questions a chunk, if all chunks arrive before the first step, the last one first. */
  function questionsPerChunk(chunks: number): number {
    const log: FakeLog = {fields: ['p'], chunks};
    const counting = new CountingCodec(log);
    const its = new Assembler(counting, kFakeValues);
    its.take(parseFrame(headFrame(1, log)));
    for (let chunk = chunks - 1; chunk >= 0; --chunk) {
      its.take(parseFrame(fieldFrame(1, chunk, 0)));
      its.take(parseFrame(meshFrame(1, chunk)));
    }
    while (its.step([0], true)) continue;
    expect([counting.chunksApplied, counting.fieldChunksApplied()]).toEqual([chunks, chunks]);
    return counting.questions / chunks;
  }

  test('growsNoFasterThanItsPackets', () => {
    expect(questionsPerChunk(500)).toBeLessThan(30);
    expect(questionsPerChunk(8000)).toBeLessThan(30);
  });
});
