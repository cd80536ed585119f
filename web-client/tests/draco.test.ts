// Compares our decoder of Draco streams with Draco's own on every value block of the golden logs,
// and breaks streams.
import draco3d, {type Draco} from 'draco3d';
import {readdirSync, readFileSync} from 'node:fs';
import {describe, expect, test} from 'vitest';
import {kDraco} from '../core/decode/draco';
import {errorCode} from '../core/protocol/errors';
import {kTestWasm, takeWholeLog} from './whole_log';

const kGolden = new URL('../../tests/golden/valid/', import.meta.url);

interface Block {
  bytes: Uint8Array;
  count: number;
  components: number;
}

async function goldenBlocks(): Promise<Block[]> {
  const blocks: Block[] = [];
  for (const name of readdirSync(kGolden)) {
    await takeWholeLog(new Uint8Array(readFileSync(new URL(name, kGolden))), {
      decode(bytes, count, components) {
        blocks.push({bytes: bytes.slice(), count, components});
        return kDraco.decode(bytes, count, components);
      },
    });
  }
  return blocks;
}

/** Draco's own result. */
function stock(draco: Draco, {bytes, count, components}: Block): Int32Array {
  const decoder = new draco.Decoder();
  const cloud = new draco.PointCloud();
  const buffer = new draco.DecoderBuffer();
  buffer.Init(new Int8Array(bytes), bytes.length);
  expect(decoder.DecodeBufferToPointCloud(buffer, cloud).ok()).toBe(true);
  const size = 4 * count * components;
  const address = draco._malloc(size);
  decoder.GetAttributeDataArrayForAllPoints(
    cloud,
    decoder.GetAttribute(cloud, 0),
    draco.DT_INT32,
    size,
    address,
  );
  const values = draco.HEAP32.slice(address >> 2, (address + size) >> 2);
  draco._free(address);
  for (const object of [cloud, decoder, buffer]) draco.destroy(object);
  return values;
}

/** The offset of the scheme of the symbols: behind the header and one attribute's description. */
const kSchemeAt = 25;

describe.skipIf(kTestWasm === '')('a Draco stream', () => {
  test('givesWhatDracoItselfGives', async () => {
    const blocks = await goldenBlocks();
    const draco = await draco3d.createDecoderModule({});
    const schemes = new Set(blocks.map(({bytes}) => bytes[kSchemeAt]));
    // 4: so many bytes has a symbol that is not compressed
    expect([blocks.length > 30, [...schemes].sort((a, b) => a! - b!)]).toEqual([true, [0, 1, 4]]);
    for (const block of blocks)
      expect(kDraco.decode(block.bytes, block.count, block.components)).toEqual(
        stock(draco, block),
      );
  });

  test('cutOrChangedAnywhereGivesAnErrorOfOursOrOtherValues', async () => {
    const blocks = (await goldenBlocks()).filter(({bytes}) => bytes.length < 200).slice(0, 40);
    const codes = new Set<string>();
    const attempt = ({count, components}: Block, bytes: Uint8Array): void => {
      try {
        kDraco.decode(bytes, count, components);
      } catch (thrown) {
        codes.add(errorCode(thrown));
      }
    };
    for (const block of blocks) {
      for (let at = 0; at < block.bytes.length; ++at) {
        attempt(block, block.bytes.subarray(0, at));
        for (let bit = 0; bit < 8; ++bit)
          attempt(
            block,
            block.bytes.map((byte, i) => (i === at ? byte ^ (1 << bit) : byte)),
          );
      }
    }
    expect([...codes].sort()).toEqual(['bad-codec', 'bad-value']);
  });

  test('ofAnotherShapeIsBadValue', async () => {
    const [block] = await goldenBlocks();
    const {bytes, count, components} = block!;
    for (const [other, width] of [
      [count + 1, components],
      [count, components + 1],
    ] as const) {
      expect(() => kDraco.decode(bytes, other, width)).toThrow(
        expect.objectContaining({code: 'bad-value'}) as Error,
      );
    }
  });
});
