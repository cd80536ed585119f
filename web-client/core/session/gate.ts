// Holds actions back, in their order, until something is ready.

export class Gate {
  /** Null: open. */
  private waiting: (() => void)[] | null = null;

  /** Opens again once `ready` is fulfilled. If it is rejected, somebody else reports that. */
  closeUntil(ready: Promise<unknown>): void {
    this.waiting = [];
    const open = (): void => {
      const actions = this.waiting ?? [];
      this.waiting = null;
      for (const action of actions) action();
    };
    ready.then(open, () => undefined);
  }

  pass(action: () => void): void {
    if (this.waiting) this.waiting.push(action);
    else action();
  }

  /** The waiting actions are of no use any more. */
  forget(): void {
    if (this.waiting) this.waiting = [];
  }
}
