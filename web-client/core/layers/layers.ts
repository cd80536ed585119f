// The layers, in the order of a link. A new one is a file beside this, a line here, one in
// layer_work.ts, its rules in layer_rules.ts, and its controls in viewer/panels/value_controls.ts.

import {arrows} from './arrows';
import {clip} from './clip';
import {isosurfaces} from './isosurfaces';
import type {FieldLayer, Layer} from './layer';
import {parts} from './parts';
import {streamlines} from './streamlines';
import {threshold} from './threshold';
import {volume} from './volume';

const kAll = [clip, isosurfaces, threshold, parts, streamlines, arrows, volume] as const;

type Listed = (typeof kAll)[number];
type Further = Extract<Listed, {more: unknown}>['more'][number]['name'];
type Named<L> = L & {readonly name: Listed['name']};
export type LayerAttribute = Listed['name'] | Further;
/** Its name is an attribute. */
export type ListedFieldLayer = Named<FieldLayer>;

export const kLayers: readonly Named<Layer>[] = kAll;

/** Those whose attribute is a field and values of it. */
export const fieldLayers = (): ListedFieldLayer[] =>
  kLayers.flatMap((layer) => ('pointsOnly' in layer ? [layer as ListedFieldLayer] : []));
