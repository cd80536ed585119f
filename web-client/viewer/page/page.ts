// How the element's parts see the element.

import type {CameraState} from '../../webgl/camera';
import type {Direction} from '../../webgl/directions';
import type {ViewAttribute} from '../settings/settings';

export interface Attributes {
  /** Sets an attribute of the viewer; null removes it. */
  write(name: ViewAttribute, value: string | null): void;
  read(name: ViewAttribute | 'transport'): string | null;
}

export interface Page extends Attributes {
  readonly element: HTMLElement;
  readonly root: ShadowRoot;
  /** Empty if the server asks for none. */
  readonly token: string;
  /** Names in the page's address, which may be no attributes. */
  readonly unknown: readonly string[];
  /** The attributes that show the same picture again. */
  readonly view: Map<string, string>;
  /** Dispatches an event. */
  dispatch(type: string, detail: unknown): void;
  /** Tells screen readers. */
  announce(text: string): void;
}

/** The state that survives when the element leaves a document, and the requests before it. */
export interface Kept {
  /** The next view begins with this camera or standard view; null: as the attributes say. */
  start: CameraState | Direction | null;
  /** The stream was paused before there was one. */
  paused: boolean;
  /** The series is to play once it has a time bar. */
  playing: boolean;
  /** The server and the mesh that were opened last. */
  opened: string;
}
