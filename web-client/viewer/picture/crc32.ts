// CRC-32 of PNG (third edition, 5.5) and ZIP (APPNOTE 4.4.7).

const kTable = Uint32Array.from({length: 256}, (_, byte) => {
  let crc = byte;
  for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  return crc;
});

export function crc32(bytes: Uint8Array): number {
  let crc = -1;
  for (const byte of bytes) crc = (crc >>> 8) ^ kTable[(crc ^ byte) & 0xff]!;
  return ~crc >>> 0;
}
