// The worker's parts of the layers. They are a list of their own, because a page fetches without
// them.

import {clipWork} from './clip';
import {isosurfacesWork} from './isosurfaces';
import type {LayerWork} from './layer';
import {partsWork} from './parts';
import {thresholdWork} from './threshold';
import {volumeWork} from './volume';

export const kLayerWork: readonly LayerWork[] = [
  clipWork,
  isosurfacesWork,
  thresholdWork,
  partsWork,
  volumeWork,
];
