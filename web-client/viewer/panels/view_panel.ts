// Standard views, projection, and the row of actions at the panel's top.

import type {StreamState} from '../../core/session/worker_messages';
import {kDirections, type Direction} from '../../webgl/directions';
import type {Actions} from '../page/actions';
import {find, onClick} from '../page/find';
import type {Page} from '../page/page';
import type {Settings} from '../settings/settings';
import {toggle} from './markup';
import type {Panel, PanelKind} from './panel';

const kPauseIcon = 'M7.5 5v10M12.5 5v10';
const kContinueIcon = 'M6.5 4.5v11l9-5.5z';

const directions = kDirections
  .map((direction) => {
    const text = direction.replace('-', '\u2212');
    const label = `aria-label="Look from ${direction}"`;
    return `<button type="button" class="look" value="${direction}" ${label}>${text}</button>`;
  })
  .join('');

const kMarkup = `
<div class="looks" role="group" aria-label="Standard views">${directions}</div>
${toggle('parallel', 'Parallel projection')}`;

class ViewPanel implements Panel {
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
    onClick(root, '.picture', () => actions.picture());
    onClick(root, '.fullscreen', () => actions.toggleFullscreen());
    onClick(root, '.share', () => actions.share());
    onClick(root, '.help', () => actions.help());
  }

  update({parallel}: Settings): void {
    this.parallel.checked = parallel;
  }

  showState(state: StreamState): void {
    this.pause.hidden = state === 'complete' || state === 'failed';
    const goesOn = state !== 'paused' && state !== 'held';
    const title = goesOn ? 'Pause' : 'Continue';
    this.pause.ariaLabel = title;
    this.pause.title = `${title} (Space)`;
    this.pause.classList.toggle('primary', !goesOn);
    find(this.pause, 'path').setAttribute('d', goesOn ? kPauseIcon : kContinueIcon);
  }
}

export const viewPanel: PanelKind = {
  markup: kMarkup,
  make: ({page, actions}) => new ViewPanel(page, actions),
};
