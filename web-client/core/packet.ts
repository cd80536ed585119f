// Packets of a log of regions: chunks that lie somewhere.

/** [least x, y, z, largest x, y, z], included; in 256ths of the lattice. */
export type PacketBox = ArrayLike<number>;
export const kBoxSteps = 256;

export interface Packet {
  chunk: number;
  /** Coarse packets have smaller levels. */
  depth: number;
  box: PacketBox;
}
