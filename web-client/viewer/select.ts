// Filling a native select.

export function fillSelect(select: HTMLSelectElement, options: {value: string; title: string}[], chosen: string): void {
  select.replaceChildren(...options.map(({value, title}) => new Option(title, value, value === chosen, value === chosen)));
}
