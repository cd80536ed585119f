// The shares of the viewer that the cards cover. The mesh is centred in the rest.

import type {Insets} from '../../webgl/view';

/** A sheet that is pulled up covers the mesh; it does not squeeze it out of sight. */
const kMaxCovered = 0.6;
/** Share of the free width: a wider legend leaves no corner. */
const kWide = 0.6;
/** Pixels below the last row of a folded sheet (style.css says the same). */
const kSheetFoot = 16;

/** With `sheet` the panel is a sheet at the foot. */
export function insetsOf(
  host: HTMLElement,
  {panel, legend, time}: Record<'panel' | 'legend' | 'time', HTMLElement>,
  sheet: boolean,
): Insets {
  const whole = host.getBoundingClientRect();
  const card = panel.getBoundingClientRect();
  const bar = legend.getBoundingClientRect();
  const width = Math.max(whole.width, 1);
  const height = Math.max(whole.height, 1);
  const hidden = card.width === 0; // a page may hide the panel, and the legend
  const bare = bar.width === 0;
  const {top: timeTop, bottom: timeBottom, width: timeWidth} = time.getBoundingClientRect();
  if (sheet)
    return {
      left: 0,
      right: 0,
      top: bare ? 0 : Math.min(kMaxCovered, (bar.bottom - whole.top) / height),
      bottom: Math.min(
        kMaxCovered,
        ((hidden ? 0 : sheetHeight(panel)) + (timeBottom - timeTop)) / height,
      ),
    };
  const free = (hidden ? whole.right : card.left) - whole.left;
  // The legend only takes a corner, so that half of its height is enough room, unless it leaves
  // hardly any width.
  const foot = timeWidth === 0 ? 0 : whole.bottom - timeTop; // the legend stands on the time
  const high = bare ? 0 : whole.bottom - bar.top - foot;
  const bottom = (foot + high / (bar.width > kWide * free ? 1 : 2)) / height;
  return {
    left: 0,
    right: hidden ? 0 : Math.min(kMaxCovered, (whole.right - card.left) / width),
    top: 0,
    bottom: Math.min(kMaxCovered, bottom),
  };
}

/** A folded sheet counts as it stays: the figures below its row fold away with the last byte. */
function sheetHeight(panel: HTMLElement): number {
  const {top, height} = panel.getBoundingClientRect();
  const row = panel.querySelector('.progress .row')!.getBoundingClientRect();
  const isFolded = panel.classList.contains('folded') && row.height > 0;
  return isFolded ? row.bottom + kSheetFoot - top : height;
}
