// The ground that the canvas lies on: the page's own style decides, or the attribute `ground`.

import {groundStyle, kMiddle} from '../settings/ground';

const kDarkScheme = '(prefers-color-scheme: dark)';

/** Null: that of the page. The cards stay as the page has them. */
export function showGround({style}: HTMLElement, ground: string | null): void {
  for (const [name, value] of Object.entries(groundStyle(ground)))
    if (value === undefined) style.removeProperty(`--${name}`);
    else style.setProperty(`--${name}`, value);
}

/** One colour for pictures. */
export function groundColor(element: Element): string {
  const style = getComputedStyle(element);
  const its = (name: string): string => style.getPropertyValue(name).trim();
  return its('--own-ground') || its('--ground');
}

/** Light ink stands on a dark ground. The canvas has the ink of its own ground. */
export function isOnDark(element: Element): boolean {
  const [red = 0, green = 0, blue = 0] =
    getComputedStyle(element)
      .color.match(/[\d.]+/g)
      ?.map(Number) ?? [];
  return (red + green + blue) / 3 > kMiddle;
}

/** Calls `changed` when the scheme changes, until the returned function is called. */
export function watchGround(changed: () => void): () => void {
  const scheme = matchMedia(kDarkScheme);
  scheme.addEventListener('change', changed);
  return () => scheme.removeEventListener('change', changed);
}
