// How far to refine: fully, or up to a number of cells or bytes or an error. Coarser and finer
// change the cells by a factor of two.

import type {Statistics} from '../../core/decode/statistics';
import {parseNumbers} from '../../core/layers/field_values';
import {errorOfLevel, limitText, type Limit} from '../../core/protocol/limit';
import type {Manifest} from '../../core/protocol/manifest';
import type {Settings} from '../settings/settings';

const kUnits = {full: '', cells: 'cells', bytes: 'kB', error: '%'};
/** Factors from the shown unit to the limit's own. */
const kFactors = {full: 1, cells: 1, bytes: 1000, error: 0.01};

export class LevelPanel {
  private limit: Limit = {kind: 'full'};
  private readonly select: HTMLSelectElement;
  private readonly input: HTMLInputElement;

  constructor(
    private readonly root: ShadowRoot,
    private readonly write: (quality: string | null) => void,
    now: () => {statistics: Statistics; manifest: Manifest | null; fields: number[]},
  ) {
    this.select = root.querySelector('select[name=limit]')!;
    this.input = root.querySelector('input[name=limit-value]')!;
    this.select.addEventListener('change', () => {
      const kind = this.select.value as Limit['kind'];
      const {
        statistics: {bytes, tetrahedra, level},
        manifest,
        fields,
      } = now();
      // Starts from the mesh as it is now.
      const error = errorOfLevel(manifest?.levels, level, fields) ?? 0;
      const value = {
        cells: tetrahedra,
        bytes,
        error: error > 0 ? Number(error.toPrecision(2)) : 0.01,
      };
      this.set(kind === 'full' ? {kind} : {kind, value: Math.max(value[kind], Number.MIN_VALUE)});
    });
    this.input.addEventListener('change', () => {
      const [value = 0] = parseNumbers(this.input.value);
      const kind = this.select.value as Limit['kind'];
      if (kind !== 'full' && value > 0) this.set({kind, value: value * kFactors[kind]});
    });
    const scale = (factor: number): void => {
      const {statistics} = now();
      const cells = Math.round(statistics.tetrahedra * factor);
      this.set(
        cells >= statistics.total.tetrahedra
          ? {kind: 'full'}
          : {kind: 'cells', value: Math.max(1, cells)},
      );
    };
    root.querySelector('.coarser')!.addEventListener('click', () => scale(0.5));
    root.querySelector('.finer')!.addEventListener('click', () => scale(2));
  }

  update({limit}: Settings): void {
    this.limit = limit;
    this.select.value = limit.kind;
    this.root.querySelector<HTMLElement>('.limit-value')!.hidden = limit.kind === 'full';
    this.root.querySelector('.limit-unit')!.textContent = kUnits[limit.kind];
    if (limit.kind !== 'full' && this.root.activeElement !== this.input)
      this.input.value = String(Number((limit.value / kFactors[limit.kind]).toPrecision(4)));
  }

  private set(limit: Limit): void {
    if (limitText(limit) !== limitText(this.limit))
      this.write(limit.kind === 'full' ? null : limitText(limit));
  }
}
