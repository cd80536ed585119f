// The address of a view in the PNG that shows it: an iTXt chunk (PNG, third edition, 11.3.3.4).
// Beside it stand the colour space, the size in print, and texts for people.

import {QtetError} from '../../core/protocol/errors';
import {crc32} from './crc32';

const kKeyword = 'qtet-view';
const kSignature = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];
/** The signature and IHDR, which every PNG begins with. */
const kHeadBytes = 8 + 25;
/** Length, type and checksum of a chunk. */
const kFrameBytes = 12;
/** Behind the keyword: its end, no compression, no language, no translated keyword. */
const kPlain = [0, 0, 0, 0, 0];
/** The rendering intent of sRGB: perceptual (11.3.2.5). */
const kPerceptual = 0;
/** 300 dots an inch, as print wants them; then the unit, which is the metre (11.3.4.3). */
const kPixelsPerMetre = 11811;
const kMetre = 1;
/** No browser takes a longer address. */
const kMaxTextBytes = 1 << 16;
/** The largest picture of the dialog has 133 MB before compression. */
const kMaxBytes = 1 << 28;

/** Only these letters stand in a tEXt chunk. */
const kLatin = /^[\n\x20-\x7e\xa1-\xff]*$/;

/**
 * `png` with the address, colour space, size, and `texts` by their keywords. REQUIRES: a canvas of
 * sRGB made it.
 */
export function withTexts(png: Blob, address: string, texts: Record<string, string> = {}): Blob {
  const density = [0, 8, 16, 24].map((bits) => (kPixelsPerMetre >>> (24 - bits)) & 255);
  const chunks = [
    chunkOf('iTXt', [...bytesOf(kKeyword), ...kPlain, ...bytesOf(address)]),
    chunkOf('sRGB', [kPerceptual]),
    chunkOf('pHYs', [...density, ...density, kMetre]),
    ...Object.entries(texts).map(([keyword, its]) => textChunk(keyword, its)),
  ];
  return new Blob([png.slice(0, kHeadBytes), ...chunks, png.slice(kHeadBytes)], {
    type: 'image/png',
  });
}

/** The address in a PNG. Throws a QtetError with a sentence if there is none. */
export async function viewIn(file: Blob): Promise<string> {
  const refuse = (why: string): never => {
    throw new QtetError('no-picture', why);
  };
  if (file.size > kMaxBytes) refuse('The file is larger than any picture of this viewer.');
  const png = new Uint8Array(await file.arrayBuffer());
  const view = new DataView(png.buffer);
  if (kSignature.some((byte, i) => png[i] !== byte))
    refuse('The file is neither a log nor a PNG picture. qtet simplify makes logs of meshes.');
  const keyword = [...bytesOf(kKeyword), 0];
  let at = kSignature.length;
  while (at + kFrameBytes <= png.length) {
    const end = at + kFrameBytes + view.getUint32(at);
    if (end > png.length) break;
    const type = textOf(png.subarray(at + 4, at + 8));
    const data = png.subarray(at + 8, end - 4);
    if (type === 'iTXt' && keyword.every((byte, i) => data[i] === byte)) {
      if (data.length > kMaxTextBytes) refuse('The view in the picture is longer than an address.');
      if (crc32(png.subarray(at + 4, end - 4)) !== view.getUint32(end - 4))
        refuse(`The view in the picture is damaged: the checksum at byte ${end - 4} is another.`);
      if (kPlain.some((byte, i) => data[kKeyword.length + i] !== byte))
        refuse(
          'The view in the picture is compressed or in a language, as this viewer never does.',
        );
      return textOf(data.subarray(kKeyword.length + kPlain.length));
    }
    if (type === 'IEND')
      refuse(
        'The picture holds no view. Pictures that this viewer has saved hold one, until another ' +
          'program saves them.',
      );
    at = end;
  }
  return refuse(
    `The PNG picture is cut off: a chunk at byte ${at} ends behind byte ${png.length}.`,
  );
}

/** tEXt, which all programs read, where its letters are enough; else iTXt. */
function textChunk(keyword: string, text: string): Uint8Array<ArrayBuffer> {
  return kLatin.test(text)
    ? chunkOf('tEXt', [
        ...bytesOf(keyword),
        0,
        ...Array.from(text, (letter) => letter.charCodeAt(0)),
      ])
    : chunkOf('iTXt', [...bytesOf(keyword), ...kPlain, ...bytesOf(text)]);
}

function chunkOf(type: string, data: readonly number[]): Uint8Array<ArrayBuffer> {
  const chunk = new Uint8Array(kFrameBytes + data.length);
  const view = new DataView(chunk.buffer);
  view.setUint32(0, data.length);
  chunk.set([...bytesOf(type), ...data], 4);
  view.setUint32(8 + data.length, crc32(chunk.subarray(4, 8 + data.length)));
  return chunk;
}

const bytesOf = (text: string): Uint8Array => new TextEncoder().encode(text);
const textOf = (bytes: Uint8Array): string => new TextDecoder().decode(bytes);
