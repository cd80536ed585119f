// The shares of the viewer that the cards cover. The mesh is centred in the rest.

import type {Insets} from '../../three/view';

/** A sheet that is pulled up covers the mesh; it does not squeeze it out of sight. */
const kMaxCovered = 0.6;
/** Share of the free width: a wider legend leaves no corner. */
const kWide = 0.6;
/** Beside the panel and the card of a point this share of the width stays for the mesh. */
const kMinFree = 0.35;

/** `result` stands above the sheet on narrow screens, and the mesh above both. */
export function insetsOf(
  host: HTMLElement,
  {panel, legend, result}: {panel: HTMLElement; legend: HTMLElement; result: HTMLElement},
  sheet: boolean,
): Insets {
  const whole = host.getBoundingClientRect();
  const card = panel.getBoundingClientRect();
  const bar = legend.getBoundingClientRect();
  const width = Math.max(whole.width, 1);
  const height = Math.max(whole.height, 1);
  const hidden = card.width === 0; // a page may hide the panel, and the legend
  const bare = bar.width === 0;
  if (sheet) {
    const covered = result.hidden ? card.top : result.getBoundingClientRect().top;
    return {
      left: 0,
      right: 0,
      top: bare ? 0 : Math.min(kMaxCovered, (bar.bottom - whole.top) / height),
      bottom: hidden ? 0 : Math.min(kMaxCovered, (whole.bottom - covered) / height),
    };
  }
  const free = (hidden ? whole.right : card.left) - whole.left;
  // The legend only takes a corner, so that half of its height is enough room, unless it leaves
  // hardly any width.
  const bottom = bare ? 0 : (whole.bottom - bar.top) / height / (bar.width > kWide * free ? 1 : 2);
  const pointed = result.hidden ? 0 : (result.getBoundingClientRect().right - whole.left) / width;
  const left = pointed < free / width - kMinFree ? pointed : 0;
  return {
    left,
    right: hidden ? 0 : Math.min(kMaxCovered, (whole.right - card.left) / width),
    top: 0,
    bottom: Math.min(kMaxCovered, bottom),
  };
}
