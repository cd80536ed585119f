// Elements of EBML: RFC 8794, sections 4 (VINT), 5 (ID), 6 (data size) and 7 (types).

/** A byte string in pieces, so that frames are not copied. */
export type Pieces = Uint8Array<ArrayBuffer>[];

export const sizeOf = (pieces: Pieces): number => pieces.reduce((sum, {length}) => sum + length, 0);

/** The size takes eight bytes in all elements: so no size depends on another. */
export function element(id: number, content: Pieces): Pieces {
  const idBytes = id > 0xffffff ? 4 : id > 0xffff ? 3 : id > 0xff ? 2 : 1;
  const head = new DataView(new ArrayBuffer(idBytes + 8));
  for (let i = 0; i < idBytes; ++i) head.setUint8(i, id >>> (8 * (idBytes - 1 - i)));
  head.setBigUint64(idBytes, BigInt(sizeOf(content)) | (1n << 56n));
  return [new Uint8Array(head.buffer), ...content];
}

export function number(id: number, value: number): Pieces {
  const data = new DataView(new ArrayBuffer(8));
  data.setBigUint64(0, BigInt(value));
  return element(id, [new Uint8Array(data.buffer)]);
}

export const text = (id: number, its: string): Pieces =>
  element(id, [new TextEncoder().encode(its)]);
