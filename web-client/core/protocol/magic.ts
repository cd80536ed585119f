/** codec/FORMAT.md, "Header": these bytes survive no transfer that treats the file as text. */
const kMagic = [0x89, 0x51, 0x54, 0x45, 0x54, 0x0d, 0x0a, 0x1a];

/** Whether a file with these first bytes is a log. */
export function beginsLog(bytes: Uint8Array): boolean {
  return kMagic.every((byte, i) => bytes[i] === byte);
}
