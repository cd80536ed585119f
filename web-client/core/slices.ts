// Work in slices: between two of them the worker hears the page's commands.

/** `dropped`: the message that calls the next slice is under way, and nobody wants it any more. */
type SliceState = 'none' | 'due' | 'dropped';

export class Slices {
  private state: SliceState = 'none';
  /** Carries the calls: a message queues behind the page's commands, a timer would wait 4 ms. */
  private channel: MessageChannel | undefined;

  constructor(private readonly run: () => void) {}

  get isDue(): boolean {
    return this.state === 'due';
  }

  /** Calls `run` once, behind what is queued already. */
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
