// Arrows as displays and pictures have them.

export const kArrowPlaces = ['shown', 'volume', 'vertices'] as const;
export const kArrowLengths = ['magnitude', 'log', 'equal'] as const;

export interface ArrowsRequest {
  /** A field of points with three components. */
  field: number;
  /** On the surface and the cuts that are drawn, inside, or at vertices. */
  places: (typeof kArrowPlaces)[number];
  /** They have the colours of the shown field. */
  isColored: boolean;
  /** Arrows along the longest side of the mesh at rest. */
  density: number;
  length: (typeof kArrowLengths)[number];
  /** The longest arrow over the distance between two. */
  size: number;
}

/** Numbers of an arrow: its tail and its way, on the lattice, and its value. */
export const kArrowWidth = 7;

export interface ArrowSoup {
  /** The value is NaN if it is missing, or without a colour. */
  arrows: Float32Array;
  /** How many there are. */
  count: number;
  /** There would be more: they lie farther apart, or some are left out. */
  isCut: boolean;
}
