// Finds parts of the viewer's markup (template.ts). REQUIRES: the part is there.

export function find<T extends Element = HTMLElement>(root: ParentNode, selector: string): T {
  return root.querySelector<T>(selector)!;
}

/** Writes a text only where it differs: a browser paints again what is written. */
export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

/** setText for an attribute. */
export function setAttribute(element: Element, name: string, text: string): void {
  if (element.getAttribute(name) !== text) element.setAttribute(name, text);
}

export function onClick(root: ParentNode, selector: string, action: () => void): void {
  find(root, selector).addEventListener('click', action);
}
