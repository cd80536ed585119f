// Parts of the viewer's markup (template.ts), which always holds them.

export function find<T extends Element = HTMLElement>(root: ParentNode, selector: string): T {
  return root.querySelector<T>(selector)!;
}

export function onClick(root: ParentNode, selector: string, action: () => void): void {
  find(root, selector).addEventListener('click', action);
}
