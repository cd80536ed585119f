// The messages by which a session tells the page about its log.

import type {Assembler} from '../decode/assembler';
import {baseFigures} from '../picture/base_figures';
import {meshArrays} from '../picture/mesh_arrays';
import type {LogStream} from './log_stream';
import {ProgressReporter} from './progress_reporter';
import type {RequestedPart} from './requested_part';
import type {FromWorker} from './worker_messages';

export class Reports {
  /** The page has received this log's manifest. */
  hasManifest = false;
  /** The page has received this log's base mesh. */
  private hasBase = false;
  readonly progress = new ProgressReporter(() => this.sendProgress());

  constructor(
    private readonly assembler: Assembler,
    private readonly requested: RequestedPart,
    private readonly stream: LogStream,
    readonly send: (message: FromWorker) => void,
  ) {}

  /** Must be called before another log. */
  forget(): void {
    this.hasManifest = this.hasBase = false;
  }

  error(code: string, message: string): void {
    this.send({type: 'error', code, message});
  }

  /** `isMore`: fields have been added to the manifest. */
  manifest(isMore = false): void {
    const {assembler, requested, stream} = this;
    this.hasManifest = true;
    this.send({
      type: 'manifest',
      manifest: assembler.manifest!,
      digest: stream.digest,
      fields: [...requested.fields],
      ...(isMore && {isMore}),
    });
    if (!isMore) this.plan();
  }

  plan(): void {
    this.send({type: 'plan', plan: this.assembler.plan(this.requested.fields)});
  }

  /** Reports the base mesh once it is decoded. */
  base(): void {
    if (this.hasBase) return;
    const {codec} = this.assembler;
    const mesh = meshArrays(this.assembler);
    if (!mesh) return; // also between two logs, while the codec has the last one's
    if (this.requested.fields.some((field) => codec.fieldChunksApplied(field) === 0)) return;
    this.hasBase = true;
    this.send({type: 'base', figures: baseFigures(mesh)});
  }

  private sendProgress(): void {
    this.send({
      type: 'progress',
      statistics: this.requested.statistics,
      received: this.stream.receivedBytes,
      here: this.assembler.wholeFields,
      aheadEnded: this.requested.isAheadEnded,
    });
  }
}
