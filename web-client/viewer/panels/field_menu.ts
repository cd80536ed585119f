// The menu of fields, for colours and layers.

import {scalarText} from '../../core/layers/field_values';
import {kMagnitude, type Scalar} from '../../core/picture/field_scale';
import type {FieldInfo} from '../../core/protocol/fields';
import {fillSelect, type SelectOption} from '../page/select';
import {scalarTitle} from './panel';

const kTensorComponents = 6;

/**
 * Offers every field, of a series the instant that is shown. The quantities of a tensor stand
 * before its magnitude and its components, those of a vector behind them. Fields of points, of
 * cells, and own ones are in groups if there are several kinds.
 */
export function fillScalars(
  select: HTMLSelectElement,
  fields: readonly FieldInfo[],
  chosen: Scalar | null,
  pointsOnly = false,
): void {
  const usable = fields
    .map((info, field) => ({info, field}))
    .filter(({info}) => info.instant?.isShown !== false)
    .filter(({info}) => !pointsOnly || info.association === 'point');
  const optionOf = (
    scalar: Scalar,
    {association, derived, of}: FieldInfo,
  ): Required<SelectOption> => ({
    value: scalarText(scalar, fields),
    title: scalarTitle(scalar, fields),
    group:
      derived && of === undefined
        ? 'Own fields'
        : association === 'cell'
          ? 'Fields of cells'
          : 'Fields of points',
  });
  const options = usable.flatMap(({info, field}) => {
    if (info.of !== undefined) return [];
    const key = scalarText({field, component: kMagnitude}, fields);
    const quantities = usable
      .filter((its) => its.info.of === key)
      .map((its) => optionOf({field: its.field, component: kMagnitude}, its.info));
    const own = [kMagnitude, ...(info.components > 1 ? info.minimum.keys() : [])].map((component) =>
      optionOf({field, component}, info),
    );
    return info.components === kTensorComponents
      ? [...quantities, ...own]
      : [...own, ...quantities];
  });
  const grouped = new Set(options.map(({group}) => group)).size > 1;
  fillSelect(
    select,
    options.length > 0
      ? options.map(({group, ...rest}) => (grouped ? {...rest, group} : rest))
      : [{value: '', title: 'No fields'}],
    chosen ? scalarText(chosen, fields) : '',
  );
  select.disabled = options.length < 2;
}
