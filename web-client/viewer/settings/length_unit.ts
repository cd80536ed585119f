// Lengths as the axes show them, and their unit: what the page says, else that of displacements,
// which the log may know.

import type {Manifest} from '../../core/protocol/manifest';
import type {Settings} from './settings';
import {isDisplacement} from './warp';

/** How lattice coordinates become lengths. */
export interface Scale {
  origin: readonly number[];
  step: number;
  /** Empty: it is not known. */
  unit: string;
}

/** Empty: it is not known. */
export const lengthUnit = (
  {lengthUnit: given}: Pick<Settings, 'lengthUnit'>,
  {fields}: Pick<Manifest, 'fields'>,
): string => given ?? fields.find(isDisplacement)?.unit ?? '';

/** That of the axes; null: they are not shown. */
export const scaleOf = (settings: Settings, manifest: Manifest | null): Scale | null =>
  settings.axes && manifest ? {...manifest.lattice, unit: lengthUnit(settings, manifest)} : null;
