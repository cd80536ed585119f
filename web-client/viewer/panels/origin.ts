// Where a saved file comes from: mesh, field, time and place. They make its name, and it says them.

import {kNoClip} from '../../core/layers/clip';
import {scalarName} from './panel';
import {find} from '../page/find';
import type {Attributes} from '../page/page';
import type {ShownMesh} from '../page/shown_mesh';

/** Longer parts of a name are cut off. */
const kMaxLetters = 60;

/** Texts; empty: there is none. */
export interface Origin {
  mesh: string;
  field: string;
  /** "0.25 s". */
  time: string;
  place: string;
}

export function originOf(
  root: ParentNode,
  {manifest, snapshot}: Pick<ShownMesh, 'manifest' | 'snapshot'>,
  place: string,
): Origin {
  const fields = manifest?.fields ?? [];
  const color = snapshot?.color;
  const unit = manifest?.units?.get('');
  const text = color && fields[color.field]?.instant?.text;
  return {
    mesh: find(root, '.mesh-name').textContent,
    field: color ? scalarName(color, fields) : '',
    time: text ? `${text}${unit ? ` ${unit}` : ''}` : '',
    place,
  };
}

/** The planes that cut the picture: "slice x:0.5", "clip x:0.5 -y:0.3". */
export function cutOf(read: Attributes['read'], {firstCut}: Pick<ShownMesh, 'firstCut'>): string {
  const text = read('clip') ?? (firstCut === null ? kNoClip : `${'xyz'[firstCut]}:0.5`);
  if (text === kNoClip) return '';
  return `${read('clip-mode') === 'slice' ? 'slice' : 'clip'} ${text}`;
}

/** "fin_Velocity-x_t-0.25-s_clip-x-0.5.png": letters, digits, dots and signs of any system. */
export function fileNameOf({mesh, field, time, place}: Origin, ending: string): string {
  const parts = [mesh, field, time && `t ${time}`, place].map((part) =>
    part
      .replaceAll('\u2212', '-')
      .replace(/[^\p{L}\p{N}.+-]+/gu, '-')
      .replace(/^[-.]+|[-.]+$/g, '')
      .slice(0, kMaxLetters),
  );
  return `${parts.filter(Boolean).join('_') || 'mesh'}.${ending}`;
}

/** A line of them, for people. */
export const textOf = ({mesh, field, time, place}: Origin): string =>
  [mesh, field, time && `t = ${time}`, place].filter(Boolean).join(', ');
