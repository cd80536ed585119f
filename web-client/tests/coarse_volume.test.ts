import {beforeEach, expect, test} from 'vitest';
import {Assembler} from '../core/decode/assembler';
import {CoarseVolume} from '../core/session/coarse_volume';
import {kPlainDisplay, type Display} from '../core/picture/display';
import {parseFrame} from '../core/protocol/messages';
import {kCoarseCells} from '../core/picture/volume';
import {FakeCodec, fieldFrame, headFrame, kFakeValues, meshFrame, type FakeLog} from './fakes';
import '../core/session/late_code'; // it makes volumes

/** Each chunk brings one cell. */
const kLog: FakeLog = {fields: ['p', 'v'], chunks: kCoarseCells + 100};
const shows = (field: number): Display => ({
  ...kPlainDisplay,
  volume: true,
  color: {field, component: -1},
});

let codec: FakeCodec;
let coarse: CoarseVolume;

beforeEach(() => {
  codec = new FakeCodec(kLog);
  coarse = new CoarseVolume(() => Promise.resolve(new Assembler(codec, kFakeValues)));
  coarse.note(parseFrame(headFrame(1, kLog)));
});

function noteAll(field: number): void {
  for (let chunk = 0; chunk < kLog.chunks; ++chunk)
    for (const bytes of [meshFrame(1, chunk), fieldFrame(1, chunk, field)])
      coarse.note(parseFrame(bytes));
}

test('hasNoMoreCellsThanItMay', async () => {
  noteAll(0);
  await coarse.cells(-1, shows(0));
  expect([codec.chunksApplied, codec.fieldChunksApplied(0)]).toEqual([kCoarseCells, kCoarseCells]);
});

test('sendsItsCellsToWhoHasOthersAndOfAnotherField', async () => {
  noteAll(0);
  noteAll(1);
  const first = await coarse.cells(-1, shows(0));
  expect(first.cells).toBeDefined();
  expect((await coarse.cells(first.version, shows(0))).cells).toBeUndefined();
  const other = await coarse.cells(first.version, shows(1));
  expect([other.cells !== undefined, other.version !== first.version]).toEqual([true, true]);
  coarse.forget();
  await expect(coarse.cells(other.version, shows(1))).rejects.toThrow();
});

test('isRefusedWhileTheFieldHasNoValuesAndThereOnceItHas', async () => {
  noteAll(0);
  await expect(coarse.cells(-1, shows(1))).rejects.toThrow('no values');
  noteAll(1);
  expect((await coarse.cells(-1, shows(1))).cells).toBeDefined();
});
