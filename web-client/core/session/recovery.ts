// Goes on after an error of the codec, as far as that can be. Where memory ends it does without
// the fields that are not shown, or stays at a level that fits.

import type {Assembler} from '../decode/assembler';
import {errorCode, errorText, QtetError} from '../protocol/errors';
import type {Decoding} from './decoding';
import type {LogStream} from './log_stream';
import type {Publisher} from './publisher';
import type {Reports} from './reports';
import type {RequestedPart} from './requested_part';

/** The share of the cells at which memory ended that is kept: pictures need memory, too. */
const kFittingShare = 0.7;

/** Appended to the codec's message: what the user sees now, and what to do. */
const kWaysOut: Record<string, string> = {
  'bad-checksum':
    '. What came before is sound and stays on the screen. Try again to fetch the rest anew; if ' +
    'it fails at the same chunk, the file itself is damaged: "qtet verify" says where.',
  'out-of-memory': ' It stays at a level that fits. Close other tabs and try again for more.',
};
/** The same while there is no mesh. */
const kWaysOutOfNothing: Record<string, string> = {
  'bad-checksum':
    '. Nothing can be shown yet. Try again to fetch it anew; if it fails again, the file itself ' +
    'is damaged: "qtet verify" says where.',
  'out-of-memory': ' Close other tabs and try again.',
};

const kNoRoomAhead =
  'The instants of the series need more memory than the browser gives to a page.';
const kWithoutAhead = ' What is shown stays. The others come when they are shown.';

export interface RecoveryHost {
  readonly assembler: Assembler;
  readonly publisher: Publisher;
  readonly requested: RequestedPart;
  readonly decoding: Decoding;
  readonly stream: LogStream;
  readonly reports: Reports;
  advance(): void;
  /** The session stays at the limit. */
  hold(): void;
  failed(error: QtetError): void;
}

export class Recovery {
  constructor(private readonly host: RecoveryHost) {}

  guarded(action: () => void): void {
    try {
      action();
    } catch (thrown) {
      if (errorCode(thrown) === 'out-of-memory' && (this.release() || this.stayAtWhatFits()))
        return;
      this.host.decoding.stop();
      this.endBy(thrown);
    }
  }

  endBy(thrown: unknown): void {
    const code = errorCode(thrown);
    const hasMesh = this.host.requested.statistics.tetrahedra > 0;
    const wayOut = (hasMesh ? kWaysOut : kWaysOutOfNothing)[code] ?? '';
    this.host.failed(new QtetError(code, `${errorText(thrown)}${wayOut}`));
  }

  /** Nothing more comes ahead. The shown mesh stays and goes on. `fields` have lost a block. */
  aheadFailed(thrown: unknown, fields: readonly number[] = []): void {
    const {assembler, reports, requested, stream} = this.host;
    for (const field of fields) stream.giveUp(assembler.fieldKeys[field]!);
    const code = errorCode(thrown);
    const isMemory = code === 'out-of-memory';
    const cause = isMemory ? kNoRoomAhead : errorText(thrown).replace(/\.?$/, '.');
    if (requested.endAhead()) reports.error(code, `${cause}${kWithoutAhead}`);
    reports.progress.changed();
    if (isMemory) this.restart(() => undefined);
  }

  /** Leaves only what is shown in the codec. Returns false if nothing else is there. */
  private release(): boolean {
    const {host} = this;
    if (!host.requested.hasOthers) return false;
    this.restart(() => host.advance());
    return true;
  }

  /** Decodes what is shown in a fresh codec. `then` is called if it fits. */
  private restart(then: () => void): void {
    const {decoding, publisher, reports} = this.host;
    this.guarded(() => {
      decoding.restart();
      publisher.changed(true);
      reports.progress.changed();
      then();
    });
  }

  /**
   * Starts again in a fresh codec, at a limit that leaves room. Returns false if not even the base
   * mesh fits.
   */
  private stayAtWhatFits(): boolean {
    const {host} = this;
    const {tetrahedra} = host.requested.statistics;
    if (tetrahedra === 0) return false;
    host.stream.disconnect();
    const value = Math.max(1, Math.floor(kFittingShare * tetrahedra));
    host.requested.limit = {kind: 'cells', value};
    this.restart(() => {
      const message =
        'The whole mesh needs more memory than the browser gives to a page.' +
        kWaysOut['out-of-memory']!;
      host.reports.error('out-of-memory', message);
      host.hold();
    });
    return true;
  }
}
