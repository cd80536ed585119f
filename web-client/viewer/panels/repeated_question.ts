// A question to the worker that each picture asks again: one at a time, because a series plays
// faster than a large mesh answers. The last picture's is asked in the end.

export class RepeatedQuestion<Answer> {
  private state: 'free' | 'asked' | 'again' = 'free';
  /** Counts what was forgotten: late answers belong to nothing. */
  private round = 0;

  /** `ask` returns null if there is nothing to ask. */
  constructor(
    private readonly ask: () => Promise<Answer> | null,
    private readonly take: (answer: Answer) => void,
  ) {}

  repeat(): void {
    if (this.state !== 'free') return void (this.state = 'again');
    const {round} = this;
    const asked = this.ask();
    if (!asked) return;
    this.state = 'asked';
    const end = (take?: () => void): void => {
      if (round !== this.round) return;
      const isAgain = this.state === 'again';
      this.state = 'free';
      take?.();
      if (isAgain) this.repeat();
    };
    asked.then(
      (answer) => end(() => this.take(answer)),
      () => end(),
    );
  }

  /** A worker that stopped never answers: the next question does not wait for it. */
  forget(): void {
    ++this.round;
    this.state = 'free';
  }
}
