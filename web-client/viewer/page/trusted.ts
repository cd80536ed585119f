// Markup and styles under a strict Content Security Policy: no inline styles, and Trusted Types.

interface TypePolicy {
  createHTML(text: string): string;
}
interface TypePolicies {
  createPolicy(name: string, rules: TypePolicy): TypePolicy;
}

const policies = (globalThis as {trustedTypes?: TypePolicies}).trustedTypes;
const policy = policies?.createPolicy('qtet', {createHTML: (text) => text});

/** Sets the element's content. REQUIRES: `text` is the viewer's own, with nothing from outside. */
export function setMarkup(element: Element | ShadowRoot, text: string): void {
  element.innerHTML = policy?.createHTML(text) ?? text;
}

/** Puts it before a part of the root. REQUIRES: as setMarkup. */
export function insertMarkup(place: Element, text: string): void {
  const template = document.createElement('template');
  setMarkup(template, text);
  place.before(template.content);
}

/**
 * Adds the style sheet to the root, once: behind the others, or before them, where their rules win.
 */
export function adopt(
  root: ShadowRoot,
  styles: string,
  where: 'behind' | 'before' = 'behind',
): void {
  if (adopted.get(root)?.has(styles)) return;
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(styles);
  const others = [...root.adoptedStyleSheets];
  root.adoptedStyleSheets = where === 'behind' ? [...others, sheet] : [sheet, ...others];
  adopted.set(root, new Set([...(adopted.get(root) ?? []), styles]));
}
const adopted = new WeakMap<ShadowRoot, Set<string>>();
