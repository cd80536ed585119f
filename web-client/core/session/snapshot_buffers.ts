// The buffers that a snapshot transfers when it travels between threads.

import {kLayers} from '../layers/layers';
import {soupOf} from '../layers/shown';
import {buffersOfVolume} from '../picture/volume';
import type {Snapshot} from './worker_messages';

export function buffersOf(snapshot: Snapshot): ArrayBuffer[] {
  const {surface, cuts, volume, warp, streamlines, arrows: few} = snapshot;
  const soups = [surface, ...cuts, ...kLayers.map((layer) => soupOf(snapshot, layer))].filter(
    (soup) => soup !== undefined,
  );
  const arrays: ArrayBufferView[] = soups.flatMap(({positions, values, creases, paint}) => [
    positions,
    values,
    ...[creases, paint].filter((bytes) => bytes !== undefined),
  ]);
  return [
    ...arrays.map(({buffer}) => buffer as ArrayBuffer),
    ...(warp?.restEdges ? [warp.restEdges.buffer as ArrayBuffer] : []),
    ...(streamlines ? [streamlines.points.buffer as ArrayBuffer] : []),
    ...(few ? [few.arrows.buffer as ArrayBuffer] : []),
    ...(volume ? buffersOfVolume(volume) : []),
  ];
}
