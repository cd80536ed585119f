// The menu of vectors that arrows show and lines follow.

import {vectorField, vectorFields, vectorText} from '../../core/layers/streamlines_text';
import {kMagnitude} from '../../core/picture/field_scale';
import type {FieldInfo} from '../../core/protocol/fields';
import {fillSelect} from '../page/select';
import {scalarName, type PanelTools} from './panel';

/** `components`: fields with so many can be chosen. One field needs no menu. */
export function fillVectors(
  select: HTMLSelectElement,
  field: number,
  fields: readonly FieldInfo[],
  components?: readonly number[],
): void {
  const options = vectorFields(fields, components).map((its) => ({
    value: vectorText(its, fields),
    title: scalarName({field: its, component: kMagnitude}, fields).replace(/, magnitude$/, ''),
  }));
  fillSelect(select, options, vectorText(field, fields));
  select.hidden = options.length < 2;
}

/** The first choice: the field that colours, or the first one. */
export function chooseVectors({page, host}: PanelTools, components?: readonly number[]): string {
  const fields = host.mesh.manifest?.fields ?? [];
  const shown = vectorField(page.read('field'), fields, components);
  return vectorText(shown >= 0 ? shown : vectorFields(fields, components)[0]!, fields);
}
