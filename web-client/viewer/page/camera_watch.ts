// Reports the camera once it rests.

import type {CameraState} from '../../three/camera';

const kRestMs = 250;

export class CameraWatch {
  private timer: ReturnType<typeof setTimeout> | undefined;
  private told = '';

  /** `now` gives the camera, or null if there is nothing to report. */
  constructor(
    private readonly now: () => CameraState | null,
    private readonly rests: (state: CameraState) => void,
  ) {}

  /** Must be called after every frame. */
  frame(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.tell(), kRestMs);
  }

  dispose(): void {
    clearTimeout(this.timer);
  }

  private tell(): void {
    const state = this.now();
    if (!state || state.join() === this.told) return;
    this.told = state.join();
    this.rests(state);
  }
}
