// The figure of what the page shows now.

import type {Frame, View} from '../../webgl/view';
import {find} from '../page/find';
import {isOnDark} from '../page/ground';
import type {Page} from '../page/page';
import type {ShownMesh} from '../page/shown_mesh';
import {scaleOf} from '../settings/length_unit';
import type {Settings} from '../settings/settings';
import {draw, frameOf, legendOf, type Figure, type Looks} from './figure';

export interface FigureHost {
  readonly view: View | null;
  readonly mesh: ShownMesh;
  readonly settings: Settings;
}

/** The frame in which the figure's mesh is drawn, with the page's legend of now. */
export function pageFrame(page: Page, host: FigureHost, figure: Figure): Frame {
  const onDark = figure.ground === 'seen' && isOnDark(find(page.root, '.scene'));
  const {canvas} = viewOf(host);
  return {...frameOf(figure, legendOf(page.root), canvas, host.settings.axes), onDark};
}

export async function drawPage(
  page: Page,
  host: FigureHost,
  figure: Figure,
  frame = pageFrame(page, host, figure),
): Promise<OffscreenCanvas> {
  const legend = legendOf(page.root);
  const rendered = await viewOf(host).render(frame);
  try {
    return draw(figure, rendered, legend, looksOf(page, host));
  } finally {
    for (const {bitmap} of rendered.tiles) bitmap.close();
  }
}

function viewOf({view}: FigureHost): View {
  if (!view) throw new Error('The graphics have stopped.');
  return view;
}

function looksOf({element}: Page, host: FigureHost): Looks {
  const {axes, reach: bounds} = viewOf(host).pose;
  const style = getComputedStyle(element);
  const its = (name: string): string => style.getPropertyValue(name).trim();
  const scale = scaleOf(host.settings, host.mesh.manifest);
  return {
    ink: its('--scene-ink') || its('--ink'),
    softInk: its('--scene-ink-soft') || its('--ink-soft'),
    ground: its('--ground-now'),
    back: style.backgroundImage,
    font: style.fontFamily,
    axes,
    ruler: scale && bounds.length > 0 ? {...scale, bounds} : null,
  };
}
