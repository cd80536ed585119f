// The graphics of a viewer: they start, may be lost, come back, and can be restarted.

import type {CoarseCells} from '../core/picture/volume';
import {errorText} from '../core/protocol/errors';
import type {CameraState} from '../webgl/camera';
import type {Direction} from '../webgl/directions';
import type {View} from '../webgl/view';
import {openView} from '../webgl/worker_view';
import {find} from './page/find';
import type {Notices} from './page/notices';

/** Where a view begins: a camera, a standard view, or null for the first view of a mesh. */
export type ViewStart = CameraState | Direction | null;

/** Graphics without a GPU may start slowly. After this time the user may restart them or wait. */
const kStartPatienceMs = 30000;

export interface GraphicsListeners {
  opened(view: View): void;
  /** After each frame. */
  drawn(): void;
  /** A failure that the page should see, too. */
  failed(code: string, message: string): void;
  /** As Client.coarse: cells of the mesh that is shown. */
  coarse(have: number): Promise<CoarseCells>;
}

export class Graphics {
  view: View | null = null;
  private ended = false;

  constructor(
    private readonly root: ShadowRoot,
    private readonly notices: Notices,
    private readonly listeners: GraphicsListeners,
  ) {}

  /** `start` is called once there is a view. */
  async open(start: () => ViewStart): Promise<void> {
    const canvas = find<HTMLCanvasElement>(this.root, '.scene');
    const patience = setTimeout(() => this.tellOfWaiting(), kStartPatienceMs);
    try {
      const view = await this.openOn(canvas);
      if (this.ended || !canvas.isConnected) return view.dispose();
      this.view = view;
      this.notices.end('slow-view');
      const from = start();
      if (typeof from === 'string') view.look(from);
      else if (from) view.cameraState = from;
      this.listeners.opened(view);
    } catch (thrown) {
      if (!canvas.isConnected) return;
      this.listeners.failed(
        'no-view',
        `The 3D view cannot start: ${errorText(thrown)}. It needs a browser with WebGL 2; trying ` +
          'again may help.',
      );
    } finally {
      clearTimeout(patience);
    }
  }

  /** Uses another worker and another canvas: a canvas can be transferred only once. */
  async restart(start: () => ViewStart): Promise<void> {
    this.notices.endOf('graphics');
    this.view?.dispose();
    this.view = null;
    const canvas = find(this.root, '.scene');
    canvas.replaceWith(canvas.cloneNode());
    return this.open(start);
  }

  dispose(): void {
    this.ended = true;
    this.view?.dispose();
    this.view = null;
  }

  private openOn(canvas: HTMLCanvasElement): Promise<View> {
    return openView(canvas, {
      drawn: () => this.listeners.drawn(),
      lost: (lost) => this.tellOfLoss(lost),
      failed: (why) =>
        this.listeners.failed(
          'drawing',
          `Something went wrong while drawing: ${why}. If the picture is not right, try again.`,
        ),
      silent: (silent) => this.tellOfSilence(silent),
      works: (working) => {
        const hint = this.root.querySelector<HTMLElement>('.working');
        if (hint) hint.hidden = !working; // the controls may not be here yet
      },
      coarse: (have) => this.listeners.coarse(have),
    });
  }

  private tellOfWaiting(): void {
    this.notices.add(
      'slow-view',
      'The graphics have not started yet. They may only be slow; beginning anew helps if they ' +
        'hang.',
    );
  }

  private tellOfSilence(silent: boolean): void {
    if (!silent) return this.notices.end('silent-view');
    this.notices.add(
      'silent-view',
      'The part that draws does not answer: it hangs, or the browser has ended it. Try again to ' +
        'start it anew; the view stays as it is.',
    );
  }

  private tellOfLoss(lost: boolean): void {
    if (!lost) return this.notices.end('graphics-lost');
    this.listeners.failed(
      'graphics-lost',
      'The browser took the graphics away, as it does when memory is short. The picture comes ' +
        'back when it returns them; closing other tabs helps.',
    );
  }
}
