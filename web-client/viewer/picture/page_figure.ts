// The figure of what the page shows now.

import type {Frame, View} from '../../webgl/view';
import {isOnDark} from '../page/ground';
import type {Page} from '../page/page';
import {draw, frameOf, legendOf, type Figure, type Looks} from './figure';

/** The frame in which the figure's mesh is drawn, with the page's legend of now. */
export function pageFrame(page: Page, view: View, figure: Figure): Frame {
  const onDark = figure.ground === 'seen' && isOnDark(page.element);
  return {...frameOf(figure, legendOf(page.root), view.canvas), onDark};
}

export async function drawPage(
  page: Page,
  view: View,
  figure: Figure,
  frame = pageFrame(page, view, figure),
): Promise<OffscreenCanvas> {
  const legend = legendOf(page.root);
  const tiles = await view.render(frame);
  try {
    return draw(figure, tiles, legend, looksOf(page, view));
  } finally {
    for (const {bitmap} of tiles) bitmap.close();
  }
}

function looksOf({element}: Page, {pose}: View): Looks {
  const style = getComputedStyle(element);
  const its = (name: string): string => style.getPropertyValue(name).trim();
  return {
    ink: its('--ink'),
    softInk: its('--ink-soft'),
    ground: its('--ground'),
    back: style.backgroundImage,
    font: style.fontFamily,
    axes: pose.axes,
  };
}
