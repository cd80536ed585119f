// The reader of the attributes of parts. It is loaded once one of them is there, or a part is
// selected.

import type {ReadParts, readParts} from '../../core/layers/parts_text';

export const parting: {read: typeof readParts | null} = {read: null};

/** Returns true if the parts of the page cannot be read yet. `done` is called when they can. */
export function awaitsParts(read: ReadParts, done: () => void): boolean {
  if (parting.read) return false;
  if (kNames.every((name) => read(name) === null)) return false;
  import('../../core/layers/parts_text').then(
    (text) => {
      parting.read ??= text.readParts;
      done();
    },
    () => {
      parting.read ??= () => null; // the picture comes without
      done();
    },
  );
  return true;
}
const kNames = ['hidden-parts', 'part-opacity', 'part-colors'] as const;
