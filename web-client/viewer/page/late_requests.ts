// Readers of attributes that are loaded once one of the attributes is there.

import type {readArrows} from '../../core/layers/arrows_text';
import type {readParts} from '../../core/layers/parts_text';
import type {readStreamlines} from '../../core/layers/streamlines_text';
import type {ViewAttribute} from '../settings/settings';

/** Null: it is not loaded yet. */
export const lateRequests: {
  parts: typeof readParts | null;
  streamlines: typeof readStreamlines | null;
  arrows: typeof readArrows | null;
} = {parts: null, streamlines: null, arrows: null};

interface Late {
  names: readonly ViewAttribute[];
  isHere: () => boolean;
  load: () => Promise<void>;
  /** The picture comes without. */
  giveUp: () => void;
}

const kLate: readonly Late[] = [
  {
    names: ['hidden-parts', 'part-opacity', 'part-colors'],
    isHere: () => lateRequests.parts !== null,
    load: async () => {
      lateRequests.parts = (await import('../../core/layers/parts_text')).readParts;
    },
    giveUp: () => (lateRequests.parts = () => null),
  },
  {
    names: ['streamlines'],
    isHere: () => lateRequests.streamlines !== null,
    load: async () => {
      const text = await import('../../core/layers/streamlines_text');
      lateRequests.streamlines = text.readStreamlines;
    },
    giveUp: () => (lateRequests.streamlines = () => null),
  },
  {
    names: ['arrows'],
    isHere: () => lateRequests.arrows !== null,
    load: async () => {
      lateRequests.arrows = (await import('../../core/layers/arrows_text')).readArrows;
    },
    giveUp: () => (lateRequests.arrows = () => null),
  },
];

/** Returns true if some attributes cannot be read yet. `done` is called when they can. */
export function awaitsRequests(
  read: (name: ViewAttribute) => string | null,
  done: () => void,
): boolean {
  const late = kLate.filter(
    ({names, isHere}) => !isHere() && names.some((name) => read(name) !== null),
  );
  if (late.length === 0) return false;
  void Promise.all(late.map((its) => its.load().catch(() => its.giveUp()))).then(done);
  return true;
}
