// The common part of layers whose attribute is a field and values of it.

import type {Display} from '../picture/display';
import type {Scalar} from '../picture/field_scale';
import type {FieldInfo} from '../protocol/fields';
import {parseFieldValues, type FieldValues} from './field_values';
import type {FieldLayer} from './layer';

type Common = Pick<FieldLayer, 'pointsOnly' | 'read' | 'fieldOf' | 'put' | 'requestOf'>;

/** `count`: so many values; absent: any. */
interface Allowed {
  pointsOnly: boolean;
  count?: number;
}

/**
 * Reads "FIELD=VALUE,VALUE" as is allowed. The request is in the display's `layers`, where
 * a layer finds it if it has no member of its own.
 */
export function fieldLayer(name: string, {pointsOnly, count}: Allowed): Common {
  return {
    pointsOnly,
    read(text: string | null, fields: readonly FieldInfo[]): FieldValues | null {
      const request = parseFieldValues(text, fields);
      if (!request) return null;
      const fits =
        (!pointsOnly || fields[request.scalar.field]!.association === 'point') &&
        (count === undefined || request.values.length === count);
      return fits ? request : null;
    },
    fieldOf: (text) => text.replace(/=[^=]*$/s, ''),
    put(display: Display, request: FieldValues | null): void {
      if (request) display.layers = {...display.layers, [name]: request};
    },
    requestOf: (display: Display): {scalar: Scalar} | null => display.layers?.[name] ?? null,
  };
}
