// Reads the PNG files that Chromium writes (8 bits, RGB or RGBA, not interlaced) and compares
// pictures.

import {inflateSync} from 'node:zlib';

/** {width, height, at(x, y), alphaAt(x, y)}: at gives [r, g, b]. */
export function readPng(file) {
  const width = file.readUInt32BE(16);
  const height = file.readUInt32BE(20);
  const channels = {2: 3, 6: 4}[file[25]];
  if (file[24] !== 8 || channels === undefined || file[28] !== 0)
    throw new Error('this PNG is none that Chromium writes');
  const packed = [];
  for (let at = 8; at < file.length; at += 12 + file.readUInt32BE(at)) {
    if (file.toString('latin1', at + 4, at + 8) === 'IDAT')
      packed.push(file.subarray(at + 8, at + 8 + file.readUInt32BE(at)));
  }
  const pixels = unfilter(inflateSync(Buffer.concat(packed)), width * channels, height, channels);
  return {
    width,
    height,
    alphaAt: (x, y) => (channels === 4 ? pixels[(y * width + x) * channels + 3] : 255),
    at: (x, y) => [...pixels.subarray((y * width + x) * channels, (y * width + x) * channels + 3)],
  };
}

function unfilter(rows, stride, height, channels) {
  const out = Buffer.alloc(stride * height);
  for (let y = 0; y < height; ++y) {
    const filter = rows[y * (stride + 1)];
    for (let i = 0; i < stride; ++i) {
      const left = i >= channels ? out[y * stride + i - channels] : 0;
      const above = y > 0 ? out[(y - 1) * stride + i] : 0;
      const corner = i >= channels && y > 0 ? out[(y - 1) * stride + i - channels] : 0;
      const predicted = [0, left, above, (left + above) >> 1, paeth(left, above, corner)][filter];
      out[y * stride + i] = rows[y * (stride + 1) + 1 + i] + predicted;
    }
  }
  return out;
}

function paeth(left, above, corner) {
  const guess = left + above - corner;
  const [dl, da, dc] = [Math.abs(guess - left), Math.abs(guess - above), Math.abs(guess - corner)];
  if (dl <= da && dl <= dc) return left;
  return da <= dc ? above : corner;
}

/** The middle of a picture, where no card lies: every third pixel. */
function* middle(picture) {
  for (let y = Math.round(0.2 * picture.height); y < 0.75 * picture.height; y += 3) {
    for (let x = Math.round(0.1 * picture.width); x < 0.7 * picture.width; x += 3) yield [x, y];
  }
}

/** The share of the middle that is coloured like a field, not like a background. */
export function coloredShare(picture) {
  let colored = 0;
  let all = 0;
  for (const [x, y] of middle(picture)) {
    const rgb = picture.at(x, y);
    ++all;
    if (Math.max(...rgb) - Math.min(...rgb) > 40) ++colored;
  }
  return colored / all;
}

/** The share of the middle where two pictures differ visibly. */
export function differingShare(a, b) {
  let differing = 0;
  let all = 0;
  for (const [x, y] of middle(a)) {
    const other = b.at(x, y);
    ++all;
    if (a.at(x, y).some((value, c) => Math.abs(value - other[c]) > 24)) ++differing;
  }
  return differing / all;
}

/** The largest difference, of 255, between two pictures in the middle. */
export function largestDifference(a, b) {
  let most = 0;
  for (const [x, y] of middle(a)) {
    const other = b.at(x, y);
    a.at(x, y).forEach((value, c) => void (most = Math.max(most, Math.abs(value - other[c]))));
  }
  return most;
}

const kBlockPixels = 4;
/**
 * A visible difference, of 255, between the means of two blocks. Changes by antialiasing within a
 * block do not count.
 */
const kVisibleStep = 10;

/**
 * The share of blocks of 4 x 4 pixels whose means differ visibly; 1 for pictures of different
 * sizes.
 */
export function differingBlocks(a, b) {
  if (a.width !== b.width || a.height !== b.height) return 1;
  let differing = 0;
  let all = 0;
  for (let y = 0; y + kBlockPixels <= a.height; y += kBlockPixels) {
    for (let x = 0; x + kBlockPixels <= a.width; x += kBlockPixels) {
      const [mine, other] = [a, b].map((picture) => blockMean(picture, x, y));
      ++all;
      if (mine.some((value, c) => Math.abs(value - other[c]) > kVisibleStep)) ++differing;
    }
  }
  return differing / all;
}

function blockMean(picture, left, top) {
  const sums = [0, 0, 0];
  for (let y = top; y < top + kBlockPixels; ++y) {
    for (let x = left; x < left + kBlockPixels; ++x)
      picture.at(x, y).forEach((value, c) => void (sums[c] += value / kBlockPixels ** 2));
  }
  return sums;
}
