// Which shares of the viewer the cards cover, so that the mesh is centred in what is left.

import type {Insets} from '../three/mesh_view';

/** A sheet that is pulled up covers the mesh rather than squeezing it out of sight. */
const kMostCovered = 0.6;

export function insetsOf(host: HTMLElement, panel: HTMLElement, legend: HTMLElement, sheet: boolean): Insets {
  const whole = host.getBoundingClientRect();
  const card = panel.getBoundingClientRect();
  const bar = legend.getBoundingClientRect();
  const width = Math.max(whole.width, 1);
  const height = Math.max(whole.height, 1);
  if (card.width === 0) return {left: 0, right: 0, top: 0, bottom: 0};  // a page may hide the panel
  if (sheet) {
    return {
      left: 0, right: 0, top: legend.hidden ? 0 : Math.min(kMostCovered, (bar.bottom - whole.top) / height),
      bottom: Math.min(kMostCovered, (whole.bottom - card.top) / height),
    };
  }
  // The legend takes a corner only: half of its height is room enough.
  const bottom = legend.hidden ? 0 : (whole.bottom - bar.top) / height / 2;
  return {left: 0, right: Math.min(kMostCovered, (whole.right - card.left) / width), top: 0, bottom: Math.min(kMostCovered, bottom)};
}
