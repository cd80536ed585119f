// Filling a native select.

export interface SelectOption {
  value: string;
  title: string;
  group?: string;
}

/** Leaves the menu as it is when it holds these already, so that an open one does not close. */
export function fillSelect(
  select: HTMLSelectElement,
  options: SelectOption[],
  chosen: string,
): void {
  const signature = JSON.stringify(options);
  if (select.dataset.options !== signature) {
    select.dataset.options = signature;
    const groups = new Map<string, HTMLElement>();
    select.replaceChildren();
    for (const {value, title, group} of options) {
      let parent: HTMLElement = select;
      if (group !== undefined) {
        parent =
          groups.get(group) ?? Object.assign(document.createElement('optgroup'), {label: group});
        if (!groups.has(group)) select.append(parent);
        groups.set(group, parent);
      }
      parent.append(new Option(title, value));
    }
  }
  select.value = chosen;
}
