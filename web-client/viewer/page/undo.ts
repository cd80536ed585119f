// Undo and redo of the view's settings by keys. Steps are taken from the view's own events, so that
// every control, tool and page that changes the view is covered.

import {readSettings} from '../settings/settings';
import {Steps, titleOf, type Change, type ViewState} from '../settings/steps';
import {find} from './find';
import type {Page} from './page';
import type {CameraState} from '../../webgl/camera';

/** Changes of one setting that follow each other faster are one step. */
const kRestMs = 300;
/** So long the status line is seen. */
const kSaidMs = 2500;

/** Shows this camera, or (null) the first view. */
type SetCamera = (camera: CameraState | null) => void;

export class Undo {
  private readonly steps: Steps;
  /** The view after the last change that is no step yet; null if there is none. */
  private pending: ViewState | null = null;
  /** The attributes of the pending step. */
  private readonly names = new Set<string>();
  private timer: ReturnType<typeof setTimeout> | undefined;
  private saidTimer: ReturnType<typeof setTimeout> | undefined;
  /** A drag is one step however long it rests. */
  private isHeld = false;
  /** Changes in one task belong together. */
  private isSameTask = false;
  /** The last press was on this viewer: its keys count even where nothing has the focus. */
  private isTouched = false;
  /** No steps are taken while a step is undone, or before a new mesh is shown. */
  private isQuiet = false;

  constructor(
    private readonly page: Page,
    private readonly setCamera: SetCamera,
    signal: AbortSignal,
  ) {
    this.steps = new Steps(page.view);
    const {element} = page;
    const listen = (
      target: EventTarget,
      types: string[],
      action: (event: Event) => void,
      capture = false,
    ): void => types.forEach((type) => target.addEventListener(type, action, {signal, capture}));
    listen(element, ['view-change'], (event) =>
      this.change((event as CustomEvent<{name: string}>).detail.name),
    );
    listen(element, ['camera-change'], () => this.change('camera'));
    listen(element, ['load'], () => this.begin());
    listen(
      document,
      ['pointerdown'],
      (event) => {
        this.isTouched = event.composedPath().includes(element);
        this.isHeld = this.isTouched;
      },
      true,
    );
    listen(document, ['pointerup', 'pointercancel'], () => this.release(), true);
    listen(document, ['keydown'], (event) => this.press(event as KeyboardEvent));
    signal.addEventListener('abort', () => {
      clearTimeout(this.timer);
      clearTimeout(this.saidTimer);
    });
  }

  /** Another mesh is on the screen. */
  private begin(): void {
    if (!this.isQuiet) return;
    this.isQuiet = false;
    this.steps.restart(this.page.view);
  }

  private change(name: string): void {
    if (name === 'mesh') {
      this.drop();
      this.isQuiet = true;
    }
    if (this.isQuiet) return;
    if (!this.isHeld && !this.isSameTask && !this.names.has(name)) this.take();
    this.names.add(name);
    this.pending = this.page.view;
    this.isSameTask = true;
    queueMicrotask(() => {
      this.isSameTask = false;
    });
    this.restart();
  }

  private release(): void {
    this.isHeld = false;
    this.restart();
  }

  private restart(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      if (!this.isHeld) this.take();
    }, kRestMs);
  }

  /** The pending changes become a step. */
  private take(): void {
    if (this.pending) this.steps.take(this.pending);
    this.drop();
  }

  private drop(): void {
    clearTimeout(this.timer);
    this.pending = null;
    this.names.clear();
  }

  private press(event: KeyboardEvent): void {
    const way = wayOf(event);
    const path = event.composedPath();
    const isOurs =
      path.includes(this.page.element) || (this.isTouched && path[0] === document.body);
    if (!way || !isOurs || event.defaultPrevented || isText(path[0])) return;
    event.preventDefault();
    this.take();
    const made = this.steps[way]();
    if (made) this.apply(made);
    const done = way === 'undo' ? 'Undone' : 'Redone';
    this.say(made ? `${done}: ${titleOf(made)}` : `Nothing to ${way}`);
  }

  private apply(made: readonly Change[]): void {
    const was = this.isQuiet;
    this.isQuiet = true;
    for (const [name, value] of made) {
      if (name === 'camera') this.setCamera(readSettings(() => value).camera);
      else this.page.write(name as Parameters<Page['write']>[0], value);
    }
    this.isQuiet = was;
  }

  private say(text: string): void {
    this.page.announce(text);
    const line = find(this.page.root, '.live');
    line.className = 'live card tool-hint';
    clearTimeout(this.saidTimer);
    this.saidTimer = setTimeout(() => {
      line.className = 'live visually-hidden';
    }, kSaidMs);
  }
}

/** The meaning of a key; null for none. */
export function wayOf({
  key,
  ctrlKey,
  metaKey,
  altKey,
  shiftKey,
}: Pick<KeyboardEvent, 'key' | 'ctrlKey' | 'metaKey' | 'altKey' | 'shiftKey'>):
  'undo' | 'redo' | null {
  if (altKey || ctrlKey === metaKey) return null;
  if (key.toLowerCase() === 'z') return shiftKey ? 'redo' : 'undo';
  return key.toLowerCase() === 'y' && !shiftKey ? 'redo' : null;
}

/** The browser undoes what is typed here. */
function isText(target: EventTarget | undefined): boolean {
  if (target instanceof HTMLInputElement) return target.type === 'text';
  return target instanceof HTMLTextAreaElement;
}
