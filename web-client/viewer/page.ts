// The element as its parts see it.

import type {CameraState} from '../three/camera';
import type {ViewAttribute} from './settings';

export interface Attributes {
  /** Sets an attribute of the viewer; null removes it. */
  write(name: ViewAttribute, value: string | null): void;
  read(name: ViewAttribute): string | null;
}

export interface Page extends Attributes {
  readonly element: HTMLElement;
  readonly root: ShadowRoot;
  /** Empty: the server asks for none. */
  readonly token: string;
  /** Attributes that show the same picture again. */
  readonly view: Map<string, string>;
  /** Dispatches an event. */
  tell(type: string, detail: unknown): void;
  /** To screen readers. */
  announce(text: string): void;
}

/** What outlives a stay in a document. */
export interface Kept {
  /** Asked for before there was a view. */
  camera: CameraState | null;
  /** Paused before there was a stream. */
  paused: boolean;
  /** The server and the mesh that were opened last. */
  opened: string;
}
