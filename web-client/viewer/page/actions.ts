// The actions of buttons and keys.

import {clipText, movedPlane} from '../../core/layers/clip_text';
import type {Vector} from '../../core/protocol/geometry';
import {kDirections, type Direction} from '../../webgl/directions';
import type {View} from '../../webgl/view';
import type {Settings} from '../settings/settings';
import {find} from './find';
import type {KeyActions} from './keys';
import type {Page} from './page';
import {ShareDialog} from './share_dialog';

export interface ActionsHost {
  readonly settings: Settings;
  readonly view: View | null;
  /** Null before the first picture is on the screen. */
  readonly later: {
    picture(): Promise<void>;
    readonly time: {
      toggle(): void;
      step(by: number): void;
      goTo(at: number): void;
      readonly isShown: boolean;
      isPlaying: boolean;
    };
    readonly panels: {
      readonly inspect: {
        readonly pointed: Vector | null;
        pickMiddle(): void;
        use(tool: 'none'): void;
      };
    };
  } | null;
  /** Shows a standard view, or (null) the first one, beside the cards that are open now. */
  look(direction: Direction | null): void;
  togglePause(): void;
  failed(code: string, message: string): void;
}

export class Actions {
  private readonly shareDialog: ShareDialog;

  constructor(
    private readonly page: Page,
    private readonly host: ActionsHost,
  ) {
    this.shareDialog = new ShareDialog(page);
  }

  look(direction: Direction | null): void {
    this.host.look(direction);
  }

  togglePause(): void {
    this.host.togglePause();
  }

  share(): void {
    this.shareDialog.show();
  }

  help(): void {
    find<HTMLDialogElement>(this.page.root, '.help-dialog').showModal();
  }

  /** Opens the dialog that makes a picture. */
  picture(): void {
    void this.host.later?.picture();
  }

  toggleFullscreen(): void {
    if (document.fullscreenElement) {
      void document.exitFullscreen();
      return;
    }
    this.page.element.requestFullscreen().catch(() => {
      this.host.failed(
        'no-fullscreen',
        'The browser does not give the whole screen to this page. Its own menu may.',
      );
    });
  }

  /** Key actions for the canvas of `view`. */
  keys(view: View): KeyActions {
    return {
      turn: (horizontal, vertical) => view.turn(horizontal, vertical),
      pan: (right, up) => view.pan(right, up),
      centre: () => {
        const point = this.host.later?.panels.inspect.pointed;
        if (point) view.centre(point);
        else this.look(null);
      },
      zoom: (factor) => view.zoom(factor),
      look: (direction) => this.look(direction === null ? null : kDirections[direction]!),
      toggle: (what) => this.toggle(what),
      moveClip: (step) => this.moveClip(step),
      stepTime: (by) => this.host.later?.time.step(by),
      goToTime: (at) => this.host.later?.time.goTo(at),
      inspect: () => this.host.later?.panels.inspect.pickMiddle(),
      picture: () => this.picture(),
      help: () => this.help(),
      escape: () => this.host.later?.panels.inspect.use('none'),
    };
  }

  /** Moves the first clip plane by a share of the extent. */
  private moveClip(step: number): void {
    const {planes, hasFirstCut} = this.host.settings;
    const [plane] = planes;
    if (!plane) return;
    this.page.write('clip', clipText(movedPlane(planes, 0, plane.share + step), hasFirstCut));
  }

  private toggle(what: Parameters<KeyActions['toggle']>[0]): void {
    const {page} = this;
    const {axes, parallel, edges, planes, hasFirstCut} = this.host.settings;
    switch (what) {
      case 'parallel':
        return page.write('projection', parallel ? null : 'parallel');
      case 'edges':
        return page.write('edges', edges ? 'off' : null);
      case 'axes':
        return page.write('axes', axes ? null : 'on');
      case 'extremes':
        return page.write('extremes', page.read('extremes') === 'on' ? null : 'on');
      case 'clip':
        return page.write('clip', planes.length > 0 ? clipText([], hasFirstCut) : 'x:0.5');
      case 'pause':
        return this.host.later?.time.isShown ? this.host.later.time.toggle() : this.togglePause();
      case 'fullscreen':
        return this.toggleFullscreen();
    }
  }
}
