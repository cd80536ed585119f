// An instant of a series leaves the last one on the screen until it has values.

import type {Assembler} from '../decode/assembler';
import {derivation} from '../picture/derivation';
import type {Display} from '../picture/display';
import type {Scalar} from '../picture/field_scale';
import type {Warp} from '../picture/warp';

/** The content of the last picture. */
export interface Drawn {
  color: Scalar | null;
  /** The fields that a derived colour is made of; absent: it is no derived one. */
  inputs?: readonly number[];
  /** Null: the mesh is at rest. */
  warp: Warp | null;
  /** Absent: none are asked for. */
  streamlines?: Display['streamlines'];
  arrows?: Display['arrows'];
  /** The chunks of its mesh. */
  chunks: number;
}

type Lines = Display['streamlines'];

/** A wanted instant has no values yet, while another one of its series is shown. */
export function isWaiting(assembler: Assembler, wanted: Display, drawn: Drawn | null): boolean {
  if (!drawn) return false;
  const {color, warp} = wanted;
  const isComponent = color?.component === drawn.color?.component;
  return (
    (isComponent && waitsFor(assembler, color, drawn.color)) ||
    waitsFor(assembler, warp, drawn.warp) ||
    waitsFor(assembler, wanted.streamlines, drawn.streamlines) ||
    waitsFor(assembler, wanted.arrows, drawn.arrows) ||
    derivation
      .inputs?.(wanted, drawn)
      .some(([its, before]) => waitsFor(assembler, {field: its}, {field: before})) === true
  );
}

/**
 * The display as it can be drawn now. If colour, warp, lines and arrows are series, they change
 * together.
 */
export function drawable(assembler: Assembler, wanted: Display, drawn: Drawn | null): Display {
  if (!drawn || !isWaiting(assembler, wanted, drawn)) return wanted;
  const held = <T extends {field: number}>(
    its: T | null | undefined,
    before: {field: number} | null | undefined,
  ): T | null | undefined =>
    its && before && areOfSeries(assembler, its, before) ? {...its, field: before.field} : its;
  const {color, warp, streamlines, arrows} = wanted;
  // the instants of path lines go with the one that is shown
  const heldLines = (its: Lines, before: Lines): Lines => {
    const lines = held(its, before);
    return lines && before?.field === lines.field
      ? {...before, seeds: lines.seeds, limits: lines.limits}
      : lines;
  };
  const display: Display = {
    ...wanted,
    color: held(color, drawn.color) ?? null,
    warp: held(warp, drawn.warp) ?? null,
    ...(streamlines && {streamlines: heldLines(streamlines, drawn.streamlines) ?? null}),
    ...(arrows && {arrows: held(arrows, drawn.arrows) ?? null}),
  };
  return derivation.held?.(display, drawn) ?? display;
}

/** The wanted instant has no values, or more of them are decoded soon. */
function waitsFor(
  assembler: Assembler,
  wanted: {field: number} | null | undefined,
  before: {field: number} | null | undefined,
): boolean {
  const {codec} = assembler;
  if (!wanted || !before || !areOfSeries(assembler, wanted, before)) return false;
  if (wanted.field === before.field || codec.fieldChunksApplied(before.field) === 0) return false;
  const applied = codec.fieldChunksApplied(wanted.field);
  const mayGrow = applied < codec.chunksApplied;
  return applied === 0 || (mayGrow && assembler.receivedOfField(wanted.field) > applied);
}

/** Both are instants of one series. */
function areOfSeries({manifest}: Assembler, a: {field: number}, b: {field: number}): boolean {
  const series = manifest?.fields[a.field]?.instant?.series;
  return series !== undefined && series === manifest?.fields[b.field]?.instant?.series;
}
