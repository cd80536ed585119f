// The buffers that a snapshot transfers when it travels between threads.

import {buffersOfVolume} from '../picture/volume';
import type {Snapshot} from './worker_messages';

export function buffersOf({surface, cuts, isosurface, volume}: Snapshot): ArrayBuffer[] {
  const soups = [surface, ...cuts, isosurface].filter((soup) => soup !== undefined);
  const arrays: ArrayBufferView[] = soups.flatMap(({positions, values}) => [positions, values]);
  return [
    ...arrays.map(({buffer}) => buffer as ArrayBuffer),
    ...(volume ? buffersOfVolume(volume) : []),
  ];
}
