// Runs work in slices: between two of them the worker receives the page's commands.

/** `dropped`: the message that starts the next slice is under way, but the slice is unwanted. */
type SliceState = 'none' | 'due' | 'dropped';

export class Slices {
  private state: SliceState = 'none';
  /** A message queues behind the page's commands. A timer would wait 4 ms. */
  private channel: MessageChannel | undefined;

  constructor(private readonly run: () => void) {}

  get isDue(): boolean {
    return this.state === 'due';
  }

  /** Calls `run` once, behind everything that is queued. */
  call(): void {
    if (this.state === 'none') this.open().port2.postMessage(null);
    this.state = 'due';
  }

  drop(): void {
    if (this.state === 'due') this.state = 'dropped';
  }

  private open(): MessageChannel {
    if (this.channel) return this.channel;
    this.channel = new MessageChannel();
    this.channel.port1.onmessage = () => {
      const {isDue} = this;
      this.state = 'none';
      if (isDue) this.run();
    };
    return this.channel;
  }
}
