// The reader of the attributes of parts, lines and arrows. It is loaded once one of them is there,
// or a section of them is open.

import type {ViewAttribute} from '../settings/settings';
import type {readLate} from './late_readers';

export const lateRequests: {read: typeof readLate | null} = {read: null};

/** Returns true if some attributes cannot be read yet. `done` is called when they can. */
export function awaitsRequests(
  read: (name: ViewAttribute) => string | null,
  done: () => void,
): boolean {
  if (lateRequests.read || kNames.every((name) => read(name) === null)) return false;
  import('./late_readers').then(
    (readers) => {
      lateRequests.read ??= readers.readLate;
      done();
    },
    () => {
      lateRequests.read ??= () => ({}); // the picture comes without
      done();
    },
  );
  return true;
}
const kNames = ['hidden-parts', 'part-opacity', 'part-colors', 'streamlines', 'arrows'] as const;
