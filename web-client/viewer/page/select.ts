// Fills a native select.

import {isEqual} from '../../core/protocol/equal';

export interface SelectOption {
  value: string;
  title: string;
  group?: string;
}

/** The options that menus hold. */
const filled = new WeakMap<HTMLSelectElement, readonly SelectOption[]>();

/** A menu that holds these options already stays untouched, so that an open one does not close. */
export function fillSelect(
  select: HTMLSelectElement,
  options: SelectOption[],
  chosen: string,
): void {
  if (!isEqual(options, filled.get(select))) {
    filled.set(select, options);
    select.replaceChildren();
    for (const {value, title, group} of options)
      groupOf(select, group).append(new Option(title, value));
  }
  select.value = chosen;
}

/**
 * The group with this label, created for its first option; the menu itself if there is no label.
 */
function groupOf(select: HTMLSelectElement, label: string | undefined): HTMLElement {
  if (label === undefined) return select;
  const groups = [...select.querySelectorAll('optgroup')];
  const there = groups.find((group) => group.label === label);
  if (there) return there;
  const made = Object.assign(document.createElement('optgroup'), {label});
  select.append(made);
  return made;
}
