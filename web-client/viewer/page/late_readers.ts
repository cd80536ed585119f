// The part of a display that parts, lines and arrows ask for.

import {readArrows} from '../../core/layers/arrows_text';
import {readParts} from '../../core/layers/parts_text';
import {readStreamlines} from '../../core/layers/streamlines_text';
import type {Display} from '../../core/picture/display';
import {planeOf} from '../settings/clip_plane';
import type {ViewAttribute} from '../settings/settings';
import type {ShownMesh} from './shown_mesh';

/** REQUIRES: the manifest and the bounds are here. */
export function readLate(
  read: (name: ViewAttribute) => string | null,
  {manifest, selectedPart, base}: ShownMesh,
): Pick<Display, 'parts' | 'streamlines' | 'arrows'> {
  const {fields} = manifest!;
  return {
    parts: readParts(read, fields, selectedPart),
    arrows: readArrows(read, fields),
    streamlines: readStreamlines(read, manifest!, (plane) => planeOf(plane, base.bounds)),
  };
}
