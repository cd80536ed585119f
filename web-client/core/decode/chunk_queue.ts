// A priority queue of chunks: a binary heap.

export class ChunkQueue {
  private readonly heap: number[] = [];
  private readonly members = new Set<number>();

  /** The chunk with the smallest rank is first. The ranks may change before `reorder`. */
  constructor(private readonly rankOf: (chunk: number) => number) {}

  /** -1 if the queue is empty. */
  get first(): number {
    return this.heap[0] ?? -1;
  }

  /** A chunk is in the queue at most once. */
  add(chunk: number): void {
    if (this.members.has(chunk)) return;
    this.members.add(chunk);
    this.heap.push(chunk);
    this.rise(this.heap.length - 1);
  }

  /** REQUIRES: the queue is not empty. */
  removeFirst(): void {
    this.members.delete(this.first);
    const last = this.heap.pop()!;
    if (this.heap.length === 0) return;
    this.heap[0] = last;
    this.sink(0);
  }

  /** Must be called after the ranks have changed. */
  reorder(): void {
    for (let at = (this.heap.length >> 1) - 1; at >= 0; --at) this.sink(at);
  }

  clear(): void {
    this.heap.length = 0;
    this.members.clear();
  }

  private rise(at: number): void {
    for (let parent; at > 0 && this.isBefore(at, (parent = (at - 1) >> 1)); at = parent)
      this.swap(at, parent);
  }

  private sink(at: number): void {
    for (;;) {
      let min = at;
      for (const child of [2 * at + 1, 2 * at + 2])
        if (child < this.heap.length && this.isBefore(child, min)) min = child;
      if (min === at) return;
      this.swap(at, min);
      at = min;
    }
  }

  private isBefore(a: number, b: number): boolean {
    return this.rankOf(this.heap[a]!) < this.rankOf(this.heap[b]!);
  }

  private swap(a: number, b: number): void {
    [this.heap[a], this.heap[b]] = [this.heap[b]!, this.heap[a]!];
  }
}
