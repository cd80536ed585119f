// Packets: the chunks of a log of regions, each with a place.

/** [least x, y, z, largest x, y, z], included; in 256ths of the lattice. */
export type PacketBox = ArrayLike<number>;
export const kBoxSteps = 256;

export interface Packet {
  chunk: number;
  /** Coarse packets have a smaller depth. */
  depth: number;
  box: PacketBox;
}
