// A viewer's cards and controls: first those that the first picture needs, the others behind it.

import type {Later, LaterHost} from './later';
import type {Page} from './page/page';
import {Shell} from './panels/shell';

/**
 * The controls come behind the first picture, or after this time: who has no picture may want to
 * change what is shown.
 */
const kLaterMs = 5000;

export class Controls {
  /** It is built a task after the viewer. */
  shell: Shell | null = null;
  /** Null before it is loaded. */
  later: Later | null = null;
  private readonly timer = setTimeout(() => void this.load(), kLaterMs);

  constructor(
    private readonly page: Page,
    private readonly host: LaterHost,
  ) {}

  buildShell(): Shell {
    return (this.shell = new Shell(this.page, this.host, () =>
      this.later?.panels.inspect.arrange(),
    ));
  }

  /** The next picture tries again if the server is away. */
  async load(): Promise<void> {
    if (this.later) return;
    const {Later} = await import('./later').catch(() => ({Later: null}));
    if (!Later || !this.shell) return;
    const {host} = this;
    this.later ??= new Later(this.page, host, this.shell);
    host.apply();
    const {snapshot} = host.mesh;
    if (snapshot && host.view) this.later.showPicture(snapshot, host.view.pose.frameMs);
  }

  dispose(): void {
    clearTimeout(this.timer);
    this.shell?.dispose();
    this.later?.dispose();
    this.shell = this.later = null;
  }
}
