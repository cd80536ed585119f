// The cells of parts: which are hidden, and how the others are drawn. It is loaded on use.

import type {MeshArrays} from '../picture/display';
import {paintOf, type Paint} from '../picture/paint';
import type {CellPaint} from '../picture/section';
import type {PartsRequest} from '../picture/parts_request';

/** The kind of cells that hide what lies behind them: their sides are drawn at interfaces. */
const kSolid = 0xffff;

type LabelOf = (cell: number) => number;

/** Null while the label has no values. A missing one is NaN. */
export function labelsOfCells(
  mesh: Pick<MeshArrays, 'scale'>,
  {scalar, range: [low, high]}: Pick<PartsRequest, 'scalar' | 'range'>,
): LabelOf | null {
  const scale = mesh.scale(scalar);
  return scale?.ofCells ? (cell) => Math.round(low + (high - low) * scale.at(cell)) : null;
}

export function hiding(
  mesh: MeshArrays,
  request: PartsRequest,
): ((kept: Uint8Array) => void) | null {
  const labelOf = labelsOfCells(mesh, request);
  if (!labelOf || (request.hidden.length === 0 && !request.isInverse)) return null;
  const hidden = new Set(request.hidden);
  return (kept) => {
    for (let cell = 0; cell < kept.length; ++cell)
      if (hidden.has(labelOf(cell)) !== request.isInverse) kept[cell] = 0;
  };
}

/**
 * Between two parts that are seen through, the side of the more opaque one is drawn. Equal ones
 * differ by their place in the request.
 */
export function paint(mesh: MeshArrays, request: PartsRequest): CellPaint | null {
  const {opacities, colors, selected} = request;
  const labelOf = labelsOfCells(mesh, request);
  if (!labelOf || (opacities.length === 0 && colors.length === 0 && selected === null)) return null;
  const clear = [...opacities].sort((a, b) => a[1] - b[1]);
  const kindOf = new Map(clear.map(([label], rank) => [label, rank]));
  const opacityOf = new Map(opacities);
  const colorOf = new Map(colors);
  const paints = new Map<number, Paint>();
  for (const label of [...opacityOf.keys(), ...colorOf.keys(), selected].filter((x) => x !== null))
    paints.set(
      label,
      paintOf({
        color: colorOf.get(label) ?? null,
        opacity: opacityOf.get(label) ?? 1,
        isSelected: label === selected,
      }),
    );
  const plain = paintOf({color: null, opacity: 1, isSelected: false});
  return {
    kindOf: clear.length > 0 ? (cell) => kindOf.get(labelOf(cell)) ?? kSolid : null,
    write: (soup, corner, cell) => {
      soup.paint ??= new Uint8Array((4 * soup.positions.length) / 3);
      soup.hasClear = clear.length > 0;
      soup.paint.set(paints.get(labelOf(cell)) ?? plain, 4 * corner);
    },
  };
}
