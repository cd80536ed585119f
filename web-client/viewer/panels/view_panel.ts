// Standard views, projection, and the buttons for pictures, sharing and help; and the buttons at
// the panel's foot.

import type {StreamState} from '../../core/session/worker_messages';
import type {Direction} from '../../three/directions';
import type {Actions} from '../page/actions';
import {find, onClick} from '../page/find';
import type {Page} from '../page/page';
import type {Settings} from '../settings/settings';

export class ViewPanel {
  private readonly parallel: HTMLInputElement;
  private readonly pause: HTMLButtonElement;

  constructor(page: Page, actions: Actions) {
    const {root} = page;
    this.parallel = find(root, 'input[name=parallel]');
    this.pause = find(root, '.pause');
    this.parallel.addEventListener('change', () =>
      page.write('projection', this.parallel.checked ? 'parallel' : null),
    );
    for (const button of root.querySelectorAll<HTMLButtonElement>('.look'))
      button.addEventListener('click', () => actions.look(button.value as Direction));
    onClick(root, '.reset', () => actions.look(null));
    onClick(root, '.pause', () => actions.togglePause());
    onClick(root, '.picture', () => void actions.savePicture());
    onClick(root, '.fullscreen', () => actions.toggleFullscreen());
    onClick(root, '.share', () => actions.share());
    onClick(root, '.help', () => actions.help());
  }

  update({parallel}: Settings): void {
    this.parallel.checked = parallel;
  }

  showState(state: StreamState): void {
    this.pause.hidden = state === 'complete' || state === 'failed';
    this.pause.textContent = state === 'paused' || state === 'held' ? 'Continue' : 'Pause';
  }
}
