// Parts of a chunk, in file order: structure, positions, then one block a field.

export const kStructurePart = 0;
export const kPositionsPart = 1;
export const kFirstFieldPart = 2;
/** `firstPart` of the frame that holds the file's header, manifest and chunk table. */
export const kHeadPart = 0xffff;
