// A field along a line, drawn by uPlot, and all fields as a table. It is loaded at the first
// request.

import uPlot from 'uplot';
import plotStyles from 'uplot/dist/uPlot.min.css?inline';
import type {Probe} from '../../core/session/inspector';
import {formatTo} from '../page/format';
import {adopt} from '../page/trusted';

export {tableOf} from './line_table';

const kHeight = 170;
/** The readout shows this share of the line and of the values' range. */
const kShare = 1e-4;

/**
 * Two values at one distance are a jump. The distances ascend, as uPlot requires. Missing values
 * leave a gap.
 */
export function drawProbe(
  root: ShadowRoot,
  place: HTMLElement,
  probe: Probe,
  title: string,
): {destroy(): void} {
  adopt(root, plotStyles);
  const known = probe.values.filter((value) => !Number.isNaN(value));
  const resolution = kShare * (Math.max(...known) - Math.min(...known)) || kShare;
  const style = getComputedStyle(root.host);
  const ink = style.getPropertyValue('--ink-soft').trim();
  const axis: uPlot.Axis = {
    stroke: ink,
    grid: {stroke: style.getPropertyValue('--line').trim(), width: 1},
    ticks: {show: false},
    font: '12px system-ui',
    values: (_self, ticks, _axis, _space, step) => ticks.map((tick) => formatTo(tick, step)),
  };
  const data: uPlot.AlignedData = [
    probe.at,
    probe.values.map((value) => (Number.isNaN(value) ? null : value)),
  ];
  const plot = new uPlot(
    {
      width: place.clientWidth,
      height: kHeight,
      legend: {show: false},
      cursor: {points: {size: 7}, drag: {x: false, y: false}},
      scales: {x: {time: false}},
      axes: [
        {...axis, size: 28},
        {...axis, size: 62},
      ],
      series: [
        {},
        {
          label: title,
          stroke: style.getPropertyValue('--accent').trim(),
          width: 2,
          points: {show: false},
        },
      ],
      hooks: {
        setCursor: [
          (self) => {
            const i = self.cursor.idx;
            const readout = place.parentElement!.querySelector('.hint')!;
            readout.textContent =
              i == null
                ? title
                : `${title} ${formatTo(probe.values[i]!, resolution)} at ` +
                  formatTo(probe.at[i]!, kShare * probe.length);
          },
        ],
      },
    },
    data,
    place,
  );
  place.setAttribute('role', 'img');
  place.setAttribute('aria-label', `${title} along the line`);
  return {destroy: () => plot.destroy()};
}
