import {expect, test} from 'vitest';
import {crc32} from '../viewer/picture/crc32';
import {Zip} from '../viewer/picture/zip';

const textOf = (its: ArrayBuffer): string => new TextDecoder().decode(its);

/** Reads by the central directory, and compares each header with that of its file. */
function filesIn(zip: ArrayBuffer): Map<string, {data: ArrayBuffer; crc: number; time: number[]}> {
  const view = new DataView(zip);
  const end = zip.byteLength - 22;
  const u16 = (at: number): number => view.getUint16(at, true);
  const u32 = (at: number): number => view.getUint32(at, true);
  expect(u32(end)).toBe(0x06054b50);
  const count = u16(end + 10);
  expect(u16(end + 8)).toBe(count);
  const files = new Map<string, {data: ArrayBuffer; crc: number; time: number[]}>();
  let at = u32(end + 16);
  expect(at + u32(end + 12)).toBe(end);
  for (let i = 0; i < count; ++i) {
    expect(u32(at)).toBe(0x02014b50);
    const local = u32(at + 42);
    expect(u32(local)).toBe(0x04034b50);
    const header = (start: number): Buffer => Buffer.from(zip, start, 26);
    expect(header(local + 4).equals(header(at + 6))).toBe(true);
    expect([u16(at + 8), u16(at + 10)]).toEqual([0x800, 0]); // UTF-8, stored
    const [size, nameBytes] = [u32(at + 24), u16(at + 28)];
    expect(u32(at + 20)).toBe(size);
    const start = local + 30 + nameBytes;
    files.set(textOf(zip.slice(at + 46, at + 46 + nameBytes)), {
      data: zip.slice(start, start + size),
      crc: u32(at + 16),
      time: [u16(at + 12), u16(at + 14)],
    });
    at += 46 + nameBytes;
  }
  expect(at).toBe(end);
  return files;
}

test('theChecksumIsThatOfTheStandard', () => {
  const bytes = new TextEncoder().encode('123456789');
  expect(crc32(bytes)).toBe(0xcbf43926);
  expect(crc32(new Uint8Array())).toBe(0);
});

test('whatIsAddedIsReadBack', async () => {
  const zip = new Zip(new Date(2026, 10, 27, 13, 14, 15));
  const contents = new Map([
    ['fin-0001.png', new Uint8Array(70000).map((_, i) => 31 * i)],
    ['h\u00f6he-0002.png', new Uint8Array()],
    ['fin-0003.png', new Uint8Array([1, 2, 3])],
  ]);
  for (const [name, data] of contents) await zip.add(name, new Blob([data]));
  const made = zip.end();
  expect(made.type).toBe('application/zip');
  const files = filesIn(await made.arrayBuffer());
  expect([...files.keys()]).toEqual([...contents.keys()]);
  for (const [name, {data, crc, time}] of files) {
    expect(new Uint8Array(data)).toEqual(contents.get(name));
    expect(crc).toBe(crc32(contents.get(name)!));
    expect(time).toEqual([(13 << 11) | (14 << 5) | 7, (46 << 9) | (11 << 5) | 27]);
  }
});

test('anEmptyFileIsAFile', async () => {
  expect(filesIn(await new Zip().end().arrayBuffer()).size).toBe(0);
});
