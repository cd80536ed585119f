// The menu of vectors that arrows show and lines follow.

import {lineField, lineFields, lineFieldText} from '../../core/layers/streamlines_text';
import {kMagnitude} from '../../core/picture/field_scale';
import type {FieldInfo} from '../../core/protocol/fields';
import {fillSelect} from '../page/select';
import {scalarName, type PanelTools} from './panel';

/** One field needs no menu. */
export function fillVectors(
  select: HTMLSelectElement,
  field: number,
  fields: readonly FieldInfo[],
): void {
  const options = lineFields(fields).map((its) => ({
    value: lineFieldText(its, fields),
    title: scalarName({field: its, component: kMagnitude}, fields).replace(/, magnitude$/, ''),
  }));
  fillSelect(select, options, lineFieldText(field, fields));
  select.hidden = options.length < 2;
}

/** The first choice: the vectors that colour, or the first ones. */
export function chooseVectors({page, host}: PanelTools): string {
  const fields = host.mesh.manifest?.fields ?? [];
  const shown = lineField(page.read('field'), fields);
  return lineFieldText(shown >= 0 ? shown : lineFields(fields)[0]!, fields);
}
