import {deflateSync} from 'node:zlib';
import {describe, expect, test} from 'vitest';
import {viewIn, withTexts} from '../viewer/picture/png_view';

const kAddress = 'https://a.org/v/?mesh=fin&field=Größe&camera=1%2C2';
const kSignature = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];

/** CRC-32 as a table of PNG's annex D gives it; the viewer's own goes bit by bit. */
function crc32(bytes: Uint8Array): number {
  const table = Array.from({length: 256}, (_, n) => {
    let c = n;
    for (let k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
    return c >>> 0;
  });
  let crc = 0xffffffff;
  for (const byte of bytes) crc = table[(crc ^ byte) & 255]! ^ (crc >>> 8);
  return (crc ^ 0xffffffff) >>> 0;
}

function chunk(type: string, data: Uint8Array): Uint8Array {
  const bytes = Buffer.alloc(12 + data.length);
  bytes.writeUInt32BE(data.length);
  bytes.write(type, 4, 'latin1');
  bytes.set(data, 8);
  bytes.writeUInt32BE(crc32(bytes.subarray(4, 8 + data.length)), 8 + data.length);
  return bytes;
}

/** One grey pixel, with these chunks between its own. */
function png(...more: Uint8Array[]): Blob {
  const head = new Uint8Array([0, 0, 0, 1, 0, 0, 0, 1, 8, 0, 0, 0, 0]);
  const data = new Uint8Array(deflateSync(new Uint8Array([0, 128])));
  const parts = [chunk('IHDR', head), ...more, chunk('IDAT', data)];
  return new Blob([new Uint8Array(kSignature), ...parts, chunk('IEND', new Uint8Array())].map(own));
}

const own = (bytes: Uint8Array): Uint8Array<ArrayBuffer> => new Uint8Array(bytes);
const bytesOf = async (blob: Blob): Promise<Uint8Array<ArrayBuffer>> =>
  new Uint8Array(await blob.arrayBuffer());
const text = (...parts: string[]): Uint8Array => new TextEncoder().encode(parts.join('\0'));

describe('the address of a view', () => {
  test('comesBackFromThePictureThatItWasPutInto', async () => {
    expect(await viewIn(withTexts(png(), kAddress))).toBe(kAddress);
    expect(await viewIn(withTexts(png(), ''))).toBe('');
  });

  test('standsInAChunkAsTheStandardSaysAndTheRestStays', async () => {
    const plain = await bytesOf(png());
    const bytes = await bytesOf(withTexts(png(), kAddress));
    const its = chunk('iTXt', text('qtet-view', '\0', '', '', kAddress));
    const rest = [
      ...chunk('sRGB', Uint8Array.of(0)),
      // 11811 pixels a metre are 300 an inch
      ...chunk('pHYs', Uint8Array.of(0, 0, 0x2e, 0x23, 0, 0, 0x2e, 0x23, 1)),
      ...plain.slice(33),
    ];
    expect([...bytes]).toEqual([...plain.slice(0, 33), ...its, ...rest]);
  });

  test('hasTextsBesideItInLatin1OrElseInUnicode', async () => {
    const bytes = await bytesOf(withTexts(png(), kAddress, {Title: 'Größe', Description: '流 x'}));
    const whole = Buffer.from(bytes).toString('latin1');
    const latin = Uint8Array.from('Title\0Größe', (letter) => letter.charCodeAt(0));
    expect(whole).toContain(Buffer.from(chunk('tEXt', latin)).toString('latin1'));
    const unicode = chunk('iTXt', text('Description', '\0', '', '', '流 x'));
    expect(whole).toContain(Buffer.from(unicode).toString('latin1'));
    expect(await viewIn(new Blob([bytes]))).toBe(kAddress);
  });

  test('isFoundBetweenChunksOfOthers', async () => {
    const others = [
      chunk('tEXt', text('qtet-view', 'no')),
      chunk('iTXt', text('qtet-viewer', '\0', '', '', 'no')),
      chunk('iTXt', text('qtet-view', '\0', '', '', kAddress)),
    ];
    expect(await viewIn(png(...others))).toBe(kAddress);
  });

  const refused = (file: Blob, why: RegExp): Promise<void> =>
    expect(viewIn(file)).rejects.toMatchObject({
      code: 'no-picture',
      message: expect.stringMatching(why) as string,
    });

  test('isRefusedFromOtherFilesByASentence', async () => {
    await refused(new Blob([]), /nor a PNG/);
    await refused(new Blob(['GIF89a and more']), /nor a PNG/);
    await refused(png(), /holds no view/);
    await refused(png(chunk('tEXt', text('qtet-view', kAddress))), /holds no view/);
    await refused(png(chunk('iTXt', text('qtet-view', '\x01', '', '', 'x'))), /compressed/);
    await refused(png(chunk('iTXt', text('qtet-view', '\0', 'de', '', 'x'))), /language/);
    const long = 'x'.repeat(70000);
    await refused(withTexts(png(), long), /longer than an address/);
  });

  test('isNeverWrongWhereverThePictureIsCutOff', async () => {
    const whole = await bytesOf(withTexts(png(), kAddress));
    const end = 33 + 12 + 'qtet-view'.length + 5 + Buffer.byteLength(kAddress);
    for (let length = 0; length < end; ++length)
      await refused(new Blob([whole.slice(0, length)]), length < 8 ? /nor a PNG/ : /cut off/);
    expect(await viewIn(new Blob([whole.slice(0, end)]))).toBe(kAddress);
  });

  test('isNeverWrongWhicheverBitOfItsChunkIsFlipped', async () => {
    const whole = await bytesOf(withTexts(png(), kAddress));
    const end = 33 + 12 + 'qtet-view'.length + 5 + Buffer.byteLength(kAddress);
    for (let bit = 8 * 33; bit < 8 * end; ++bit) {
      const damaged = whole.slice();
      damaged[bit >> 3]! ^= 1 << (bit & 7);
      await refused(new Blob([damaged]), /damaged|cut off|holds no view|longer/);
    }
  });
});
