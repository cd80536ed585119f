// The known error against bytes, and the point that is reached.

import type {LevelBytes} from '../../core/decode/plan';
import type {Statistics} from '../../core/decode/statistics';
import {errorOfLevel} from '../../core/protocol/limit';
import type {Manifest} from '../../core/protocol/manifest';
import {find, setAttribute, setText} from '../page/find';
import {formatBytes, formatError} from '../page/format';
import {labelName} from './panel';

/** The curve spans errors from the first one down to at most this fraction of it. */
const kMinSpan = 10;

/** Bytes, and the error that is left with them. */
type Point = [number, number];

export class ErrorCurve {
  constructor(private readonly figure: HTMLElement) {}

  /**
   * Both axes are logarithmic, from the first level's error to the last one that is not 0. Behind
   * it the line goes to the ground. The reached point has the bytes that are here.
   */
  draw(
    plan: readonly LevelBytes[],
    {bytes, level: now}: Statistics,
    {levels, fields: infos}: Pick<Manifest, 'levels' | 'fields'>,
    fields: readonly number[],
  ): void {
    const {figure} = this;
    const points = plan.map(({bytes: needed, level}) => ({
      level,
      point: [needed, errorOfLevel(levels, level, fields) ?? 0] as Point,
    }));
    const line = points.map(({point}) => point);
    const [firstBytes, firstError] = line[0] ?? [0, 0];
    figure.hidden = line.length < 2 || firstError === 0;
    if (figure.hidden) return;
    const [lastBytes] = line.at(-1)!;
    const minError = Math.min(...line.map(([, error]) => error || Infinity), firstError / kMinSpan);
    const place = ([at, error]: Point): string => {
      const x = Math.log(at / firstBytes) / Math.log(Math.max(lastBytes / firstBytes, 1.01));
      const y =
        error > 0 ? (0.9 * Math.log(firstError / error)) / Math.log(firstError / minError) : 1;
      return `${(100 * Math.min(1, Math.max(0, x))).toFixed(2)} ${(40 * y).toFixed(2)}`;
    };
    const reached = points
      .filter(({level, point: [at]}) => at <= bytes && level <= now)
      .map(({point}) => point);
    const here: Point = [bytes, reached.at(-1)?.[1] ?? firstError];
    if (reached.length > 0) reached.push(here);
    for (const [name, drawn] of [
      ['ahead', line],
      ['reached', reached],
    ] as const) {
      const path = drawn.length > 0 ? `M${drawn.map(place).join('L')}` : '';
      setAttribute(find(figure, `.${name}`), 'd', path);
    }
    setAttribute(find(figure, '.here'), 'd', `M${place(here)}h0`);
    const ends = [
      line[0]!,
      ...(bytes > firstBytes && bytes < lastBytes ? [here] : []),
      line.at(-1)!,
    ];
    const texts = ends.map(([at, error]) => `${formatError(error)} at ${formatBytes(at)}`);
    const label = labelName(fields, infos);
    const what = label === null ? 'Error' : `Volume with another ${label}`;
    setText(find(figure, 'figcaption'), `${what} against bytes: ${texts.join(', ')}`);
  }
}
