// Shared by the panels: how they are made and called, and the fields in their menus.

import {componentNames} from '../../core/layers/field_values';
import {kMagnitude, type Scalar} from '../../core/picture/field_scale';
import type {FieldInfo} from '../../core/protocol/fields';
import type {Manifest} from '../../core/protocol/manifest';
import type {Client} from '../../core/session/client';
import type {Pick as Picked} from '../../core/session/inspector';
import type {Snapshot, StreamState} from '../../core/session/worker_messages';
import type {View} from '../../webgl/view';
import type {Actions} from '../page/actions';
import type {Page} from '../page/page';
import type {ShownMesh} from '../page/shown_mesh';
import type {Settings, ShownRange} from '../settings/settings';

/** The mesh, as far as a panel needs it. */
export interface Scene {
  manifest: Manifest;
  bounds: number[];
  /** The field that is shown if no attribute names one. */
  firstField: number;
}

export interface PanelsHost {
  readonly client: Client;
  readonly view: View | null;
  readonly mesh: ShownMesh;
  readonly settings: Settings;
  /** The values that the colours span; null if nothing is coloured. */
  readonly range: ShownRange | null;
  /** A series plays. */
  readonly isPlaying: boolean;
  /** The state of another segment that is opened, before it has a picture; null: none is. */
  readonly opening: StreamState | null;
  readonly stream: {
    /** The address of the log that is open, as a file; empty: there is none. */
    readonly logAddress: string;
  };
  /** Brings everything in line with the attributes and the mesh. */
  apply(): void;
  failed(code: string, message: string): void;
}

export interface PanelTools {
  page: Page;
  host: PanelsHost;
  actions: Actions;
  /** The viewer ends. */
  signal: AbortSignal;
  /** Opens files of this machine. */
  take: (files: File[]) => void;
  /** Opens the card of a point, or of a line. */
  open: (picks: Picked[]) => void;
}

export interface Panel {
  /** `scene` is null while there is no mesh. */
  update?(settings: Settings, scene: Scene | null): void;
  showRange?(range: ShownRange): void;
  showState?(state: StreamState): void;
  /** `frameMs` is the time of drawing the picture. */
  showPicture?(snapshot: Snapshot, frameMs: number): void;
  /** Called after every frame. */
  follow?(): void;
  /** Called before another mesh. */
  clear?(): void;
}

/** A row of ../sections.ts. */
export interface PanelKind {
  markup: string;
  /** Called once the markup is in the page. Without it another part serves the markup. */
  make?(tools: PanelTools): Panel;
}

/** scalarName, with the unit that the log knows beside it: "Velocity, x [m/s]". */
export function scalarTitle(scalar: Scalar, fields: readonly FieldInfo[]): string {
  return withUnit(scalarName(scalar, fields), fields[scalar.field]!);
}

export const withUnit = (name: string, {unit}: Pick<FieldInfo, 'unit'>): string =>
  unit === undefined ? name : `${name} [${unit}]`;

/**
 * "Velocity, x", or "Velocity, magnitude" for a vector without a component. Components without
 * names are numbered as in addresses: "Modes[3]". Without a time.
 */
export function scalarName({field, component}: Scalar, fields: readonly FieldInfo[]): string {
  const info = fields[field]!;
  const twins = fields.filter(({name}) => name === info.name).length > 1;
  if (info.title !== undefined) return info.title;
  const plain = info.instant?.series.replace(/^cell:/, '') ?? info.name;
  const name = twins && info.association === 'cell' ? `${plain} (cells)` : plain;
  if (info.components === 1) return name;
  if (component === kMagnitude) return `${name}, magnitude`;
  const its = componentNames(info.components)[component];
  return its === undefined ? `${name}[${component}]` : `${name}, ${its}`;
}

/** The name of the one shown field if it is a label: its error is a share of the volume. */
export function labelName(shown: readonly number[], fields: readonly FieldInfo[]): string | null {
  const [field, ...more] = shown;
  if (field === undefined || more.length > 0 || !fields[field]?.labels) return null;
  return scalarName({field, component: kMagnitude}, fields);
}
