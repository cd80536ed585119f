// The ground that the canvas lies on: the page's own style decides, or the attribute `ground`.

const kDarkScheme = '(prefers-color-scheme: dark)';

/** The mean channel of a middle grey. */
export const kMiddle = 128;

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
