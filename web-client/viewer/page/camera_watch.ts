// Reports the camera once it rests.

import type {CameraState} from '../../webgl/camera';

const kRestMs = 250;

export class CameraWatch {
  private timer: ReturnType<typeof setTimeout> | undefined;
  private reported = '';

  /** `now` gives the camera, or null if there is nothing to report. */
  constructor(
    private readonly now: () => CameraState | null,
    private readonly rests: (state: CameraState) => void,
  ) {}

  /** Must be called after every frame. */
  frame(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.report(), kRestMs);
  }

  dispose(): void {
    clearTimeout(this.timer);
  }

  private report(): void {
    const state = this.now();
    if (!state || state.join() === this.reported) return;
    this.reported = state.join();
    this.rests(state);
  }
}
