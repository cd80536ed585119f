// Sections of the panel fold, and stay so when the page is opened again.

const kKey = 'qtet-viewer-folds';

/** Where a browser keeps it. A page may have none, and any use of it may throw. */
export type Shelf = Pick<Storage, 'getItem' | 'setItem'>;

/** The sections that were opened (true) or folded by the user, by name; none if unknown. */
export function readFolds(shelf: () => Shelf | null | undefined): Map<string, boolean> {
  try {
    const kept: unknown = JSON.parse(shelf()?.getItem(kKey) ?? '{}');
    const entries = Object.entries(kept as object) as [string, unknown][];
    return new Map(entries.filter((its): its is [string, boolean] => typeof its[1] === 'boolean'));
  } catch {
    return new Map();
  }
}

/** A browser that keeps nothing forgets. */
export function keepFolds(
  shelf: () => Shelf | null | undefined,
  folds: ReadonlyMap<string, boolean>,
): void {
  try {
    shelf()?.setItem(kKey, JSON.stringify(Object.fromEntries(folds)));
  } catch {
    // The user has forbidden it, or there is no room.
  }
}

/** Opens and folds the sections as they were left, and notes what the user does with them. */
export function bindFolds(root: ParentNode): void {
  const shelf = (): Shelf => localStorage;
  const kept = readFolds(shelf);
  for (const section of root.querySelectorAll<HTMLDetailsElement>('details[data-fold]')) {
    const name = section.dataset.fold!;
    section.open = kept.get(name) ?? section.open;
    let {open} = section;
    section.addEventListener('toggle', () => {
      if (section.open === open) return; // the event of its own beginning
      ({open} = section);
      keepFolds(shelf, readFolds(shelf).set(name, open));
    });
  }
}
