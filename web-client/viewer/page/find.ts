// Finds parts of the viewer's markup (template.ts). REQUIRES: the part is there.

export function find<T extends Element = HTMLElement>(root: ParentNode, selector: string): T {
  return root.querySelector<T>(selector)!;
}

export function onClick(root: ParentNode, selector: string, action: () => void): void {
  find(root, selector).addEventListener('click', action);
}
