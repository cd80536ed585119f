// Splits a value block (codec/FORMAT.md, "Value blocks") into what Draco decodes and the digits
// behind it.

import {QtetError} from '../protocol/errors';
import {kAdaptiveCodec, kDracoCodec, kLiftedCodec, type BlockValues, type Codec} from './codec';
import type {ValueDecoder} from './draco';

/** The block's last bytes hold the number of digit bytes. */
const kDigitCountBytes = 4;

export interface ValueBlockPlace {
  chunk: number;
  part: number;
  /** Integers a tuple. */
  components: number;
}

/**
 * Throws `bad-codec`, `bad-value`, and the errors of `values`. REQUIRES: `codec` has the log's
 * head.
 */
export function readValueBlock(
  codec: Codec,
  values: ValueDecoder,
  {chunk, part, components}: ValueBlockPlace,
  bytes: Uint8Array,
): BlockValues {
  const count = codec.blockValues(chunk, part);
  if (count === 0 && bytes.length === 0) return {symbols: new Int32Array(0), digits: bytes};
  const id = codec.blockCodec(chunk, part);
  if (id === kAdaptiveCodec || id === kLiftedCodec)
    return {symbols: new Int32Array(0), digits: bytes};
  if (id !== kDracoCodec)
    throw new QtetError(
      'bad-codec',
      `Chunk ${chunk} uses codec ${id}, which this viewer does not know.`,
    );
  if (count === 0)
    throw new QtetError('bad-value', `Chunk ${chunk} has a value block although it has no values.`);
  const end = bytes.length - kDigitCountBytes;
  const digitBytes =
    end < 0 ? Infinity : new DataView(bytes.buffer, bytes.byteOffset + end).getUint32(0, true);
  if (digitBytes > end)
    throw new QtetError(
      'bad-value',
      `Chunk ${chunk} has a value block that is shorter than its digits.`,
    );
  const digits = bytes.subarray(end - digitBytes, end);
  return {symbols: values.decode(bytes.subarray(0, end - digitBytes), count, components), digits};
}
