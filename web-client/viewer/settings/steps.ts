// The views that undo and redo go through. A view is what a link holds (QtetViewer.view), and a
// step is the way from one view to the next.

/** Attributes of a view by name. */
export type ViewState = ReadonlyMap<string, string>;
/** An attribute's new value; null removes it. */
export type Change = readonly [name: string, value: string | null];

/** More are never wanted back, and the memory of a view that stays open is bounded. */
export const kMaxSteps = 100;
/** The rounding of a camera that was set and is read again, as a share of its largest number. */
const kSameCamera = 1e-5;
/** Another mesh is no setting of the view. */
const kNoSetting = 'mesh';

export class Steps {
  private past: ViewState[] = [];
  private future: ViewState[] = [];

  constructor(private now: ViewState) {}

  /** Forgets all steps: the views before belong to another mesh. */
  restart(now: ViewState): void {
    this.now = now;
    this.past = [];
    this.future = [];
  }

  /** The view has changed to `next`. This is a step, unless nothing differs. */
  take(next: ViewState): void {
    if (changes(this.now, next).length > 0) {
      this.past = [...this.past, this.now].slice(-kMaxSteps);
      this.future = [];
    }
    this.now = next;
  }

  /** The changes that lead one step back; null if there is none. */
  undo(): Change[] | null {
    return this.go(this.past, this.future);
  }

  /** The changes that lead one step forth again; null if there is none. */
  redo(): Change[] | null {
    return this.go(this.future, this.past);
  }

  private go(from: ViewState[], to: ViewState[]): Change[] | null {
    const next = from.pop();
    if (!next) return null;
    const found = changes(this.now, next);
    to.push(this.now);
    this.now = next;
    return found;
  }
}

function changes(from: ViewState, to: ViewState): Change[] {
  return [...new Set([...from.keys(), ...to.keys()])].flatMap((name) => {
    const [before, after] = [from.get(name), to.get(name)];
    const isSame = name === 'camera' ? isSameCamera(before, after) : before === after;
    return isSame || name === kNoSetting ? [] : [[name, after ?? null] as const];
  });
}

function isSameCamera(before: string | undefined, after: string | undefined): boolean {
  if (before === undefined || after === undefined) return before === after;
  const [a, b] = [before, after].map((text) => text.split(',').map(Number)) as [number[], number[]];
  const size = Math.max(...a.map(Math.abs), ...b.map(Math.abs));
  return a.length === b.length && a.every((x, i) => Math.abs(x - b[i]!) <= kSameCamera * size);
}

const kTitles: Record<string, string> = {
  derived: 'own fields',
  'field-title': 'title',
  colormap: 'colour map',
  'time-range': 'part that plays',
  'time-loop': 'play once',
  beyond: 'colours beyond the range',
  edges: 'cell edges',
  'clip-mode': 'clip',
  'hidden-parts': 'parts',
  'part-opacity': 'parts',
  'part-colors': 'parts',
  warp: 'deformed shape',
  'warp-scale': 'deformed shape',
  'rest-edges': 'edges at rest',
  iso: 'isosurfaces',
  seeds: 'streamlines',
  'arrow-places': 'arrows',
  'arrow-density': 'arrows',
  'arrow-length': 'arrows',
  'arrow-size': 'arrows',
  'arrow-color': 'arrows',
  'streamline-kind': 'streamlines',
  'streamline-look': 'streamlines',
  'streamline-limits': 'streamlines',
  'length-unit': 'unit of length',
  points: 'kept points',
  lines: 'kept lines',
  extremes: 'least and largest',
  flux: 'field of the flux',
  quality: 'level of detail',
};

/** "colour map, range" for the status line: what these changes concern. */
export function titleOf(made: readonly Change[]): string {
  return [...new Set(made.map(([name]) => kTitles[name] ?? name))].join(', ');
}
