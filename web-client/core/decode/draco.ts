// Decodes positions and field blocks. Each begins with a Draco bit stream: a point cloud in
// sequential encoding, with one generic attribute of 32-bit integers and no prediction
// (codec/FORMAT.md, "Value blocks"; Draco's bitstream specification, 2.2).
//
// Why not Draco's own decoder? It weighs a fifth of the whole viewer. The tests compare both.

import {QtetError} from '../protocol/errors';

export interface ValueDecoder {
  /**
   * Decodes `count` tuples of `components` integers. Throws `bad-codec` if the bytes are no Draco
   * stream of this kind, and `bad-value` for any other fault.
   */
  decode(bytes: Uint8Array, count: number, components: number): Int32Array;
}

const kGeneric = 4;
const kInt32 = 5;
const kIntegerDecoder = 1;
const kNoPrediction = -2;
const kTagged = 0;
const kRaw = 1;
/** The size, in bits, of the alphabet that tagged symbols code bit lengths with. */
const kTagBits = 5;
const kMaxSymbolBits = 18;
const kMetadataFlag = 0x8000;

export const kDraco: ValueDecoder = {
  decode(bytes, count, components) {
    const reader = new Reader(bytes);
    readHeader(reader, count, components);
    const symbols = readIntegers(reader, count * components, components);
    for (let i = 0; i < symbols.length; ++i) symbols[i] = (symbols[i]! >>> 1) ^ -(symbols[i]! & 1);
    return symbols;
  },
};

function readHeader(reader: Reader, count: number, components: number): void {
  if (
    String.fromCharCode(reader.u8(), reader.u8(), reader.u8(), reader.u8(), reader.u8()) !== 'DRACO'
  )
    throw refused('it is no Draco stream');
  const major = reader.u8();
  reader.u8();
  const cloud = reader.u8() === 0;
  const sequential = reader.u8() === 0;
  const flags = reader.u8() | (reader.u8() << 8);
  if (major !== 2 || !cloud || flags & kMetadataFlag)
    throw refused('it is not a point cloud of Draco 2');
  // A constant costs no bits, so only this count bounds what decoding allocates.
  if (!sequential || reader.u32() !== count || reader.u8() !== 1 || reader.varint() !== 1)
    throw otherValues();
  const type = reader.u8();
  const dataType = reader.u8();
  if (type !== kGeneric || dataType !== kInt32 || reader.u8() !== components) throw otherValues();
  reader.u8(); // normalized: meaningless for integers
  reader.varint(); // the attribute's id
  if (reader.u8() !== kIntegerDecoder || reader.i8() !== kNoPrediction)
    throw refused('it predicts its values');
}

function readIntegers(reader: Reader, count: number, components: number): Int32Array {
  const out = new Int32Array(count);
  if (reader.u8() === 0) {
    const size = reader.u8();
    if (size < 1 || size > 4) throw refused('its integers have an impossible size');
    for (let i = 0; i < count; ++i)
      for (let b = 0; b < size; ++b) out[i] = out[i]! | (reader.u8() << (8 * b));
    return out;
  }
  const scheme = reader.u8();
  if (scheme === kTagged) readTagged(reader, out, components);
  else if (scheme === kRaw) readRaw(reader, out);
  else throw refused('its symbols are coded in an unknown way');
  return out;
}

/** Each tuple is a symbol that gives a bit length, followed by its values as plain bits. */
function readTagged(reader: Reader, out: Int32Array, components: number): void {
  const tags = new SymbolReader(reader, kTagBits);
  const bits = new BitReader(reader);
  for (let i = 0; i < out.length; i += components) {
    const length = tags.next();
    for (let c = 0; c < components; ++c) out[i + c] = bits.read(length);
  }
}

function readRaw(reader: Reader, out: Int32Array): void {
  const bits = reader.u8();
  if (bits < 1 || bits > kMaxSymbolBits) throw refused('its alphabet has an impossible size');
  const symbols = new SymbolReader(reader, bits);
  for (let i = 0; i < out.length; ++i) out[i] = symbols.next();
}

/** A rANS decoder with a table of probabilities. It reads the bytes from their end. */
class SymbolReader {
  private readonly precisionBits: number;
  private readonly base: number;
  /** The symbol for each remainder. */
  private readonly table: Uint32Array;
  private readonly probabilities: Uint32Array;
  private readonly starts: Uint32Array;
  private readonly bytes: Uint8Array;
  private at: number;
  private state: number;

  constructor(reader: Reader, alphabetBits: number) {
    this.precisionBits = Math.min(20, Math.max(12, (3 * alphabetBits) >> 1));
    this.base = 4 << this.precisionBits;
    this.probabilities = readProbabilities(reader);
    this.starts = new Uint32Array(this.probabilities.length);
    this.table = new Uint32Array(1 << this.precisionBits);
    this.fillTable();
    this.bytes = reader.take(reader.varint());
    const size = this.bytes.length;
    const width = size > 0 ? 1 + (this.bytes[size - 1]! >> 6) : Infinity;
    if (width > size) throw refused('its symbols end too early');
    this.at = size - width;
    let state = 0;
    for (let b = 0; b < width; ++b) state |= this.bytes[this.at + b]! << (8 * b);
    this.state = (state & ((1 << (8 * width - 2)) - 1)) + this.base;
    if (this.state >= 256 * this.base) throw refused('its symbols begin in an impossible state');
  }

  next(): number {
    while (this.state < this.base && this.at > 0)
      this.state = this.state * 256 + this.bytes[--this.at]!;
    const rest = this.state & (this.table.length - 1);
    const symbol = this.table[rest]!;
    this.state =
      (this.state >>> this.precisionBits) * this.probabilities[symbol]! +
      rest -
      this.starts[symbol]!;
    return symbol;
  }

  private fillTable(): void {
    let start = 0;
    for (let symbol = 0; symbol < this.probabilities.length; ++symbol) {
      const end = start + this.probabilities[symbol]!;
      if (end > this.table.length) throw refused('its probabilities add up to too much');
      this.starts[symbol] = start;
      this.table.fill(symbol, start, end);
      start = end;
    }
    if (start !== this.table.length) throw refused('its probabilities add up to too little');
  }
}

function readProbabilities(reader: Reader): Uint32Array {
  const count = reader.varint();
  if (count > 64 * reader.remaining) throw refused('its alphabet is larger than its bytes');
  const probabilities = new Uint32Array(count);
  for (let i = 0; i < count; ++i) {
    const first = reader.u8();
    const extra = first & 3;
    if (extra === 3) {
      // a run of symbols that do not occur
      i += first >> 2;
      if (i >= count) throw refused('its alphabet ends within a run');
      continue;
    }
    let probability = first >> 2;
    for (let b = 0; b < extra; ++b) probability |= reader.u8() << (8 * b + 6);
    probabilities[i] = probability;
  }
  return probabilities;
}

class Reader {
  private at = 0;
  constructor(private readonly bytes: Uint8Array) {}

  get remaining(): number {
    return this.bytes.length - this.at;
  }
  u8(): number {
    return this.take(1)[0]!;
  }
  i8(): number {
    return (this.u8() << 24) >> 24;
  }
  u32(): number {
    return (this.u8() | (this.u8() << 8) | (this.u8() << 16) | (this.u8() << 24)) >>> 0;
  }
  varint(): number {
    let value = 0;
    for (let shift = 0; shift < 35; shift += 7) {
      const byte = this.u8();
      value += (byte & 127) * 2 ** shift;
      if (byte < 128) return value;
    }
    throw refused('it has a number that does not end');
  }
  take(count: number): Uint8Array {
    if (count > this.remaining) throw refused('it ends too early');
    this.at += count;
    return this.bytes.subarray(this.at - count, this.at);
  }
}

/** Lowest bit first. */
class BitReader {
  private bit = 8;
  private byte = 0;
  constructor(private readonly reader: Reader) {}

  read(count: number): number {
    let value = 0;
    for (let have = 0; have < count;) {
      if (this.bit === 8) {
        this.byte = this.reader.u8();
        this.bit = 0;
      }
      const now = Math.min(8 - this.bit, count - have);
      value |= ((this.byte >> this.bit) & ((1 << now) - 1)) << have;
      this.bit += now;
      have += now;
    }
    return value;
  }
}

function otherValues(): QtetError {
  return new QtetError(
    'bad-value',
    'A block of the mesh holds other values than its chunk table says.',
  );
}

function refused(why: string): QtetError {
  return new QtetError('bad-codec', `A block of the mesh cannot be decoded: ${why}.`);
}
