// The part of later instants of a session's log (codec/FORMAT.md, "Later instants"). It comes once,
// beside the stream.

import type {Assembler} from '../decode/assembler';
import {errorCode, errorText} from '../protocol/errors';
import {fetchLaterPart} from '../transport/later_part';
import {retry} from '../transport/retry';
import type {CoarseVolume} from './coarse_volume';
import type {LogStream} from './log_stream';
import type {Recovery} from './recovery';
import type {Reports} from './reports';

const kWithoutLater = ' The first instant of the series stays. Load the page again for the others.';

export interface LaterPartHost {
  readonly assembler: Assembler;
  readonly coarse: Pick<CoarseVolume, 'noteLater'> | null;
  readonly recovery: Recovery;
  readonly reports: Reports;
  readonly stream: LogStream;
}

export class LaterPart {
  /** It is under way, here, or has failed. */
  private isAsked = false;

  /** `known` is called if the manifest waited for the part, also if the part has failed. */
  constructor(
    private readonly host: LaterPartHost,
    private readonly known: () => void,
  ) {}

  /** The log has such a part, and nobody has asked for it. */
  get isMissing(): boolean {
    return !this.isAsked && this.host.assembler.laterBytes > 0;
  }

  /** The page receives the manifest once the part is here. */
  get isAwaited(): boolean {
    return this.isAsked && !this.host.reports.hasManifest;
  }

  /** Fetches the later fields. If that fails, the mesh stays without. */
  async bring(): Promise<void> {
    const {assembler, coarse, recovery, reports, stream} = this.host;
    if (!this.isMissing) return;
    this.isAsked = true;
    const {fileBytes, laterBytes, manifest} = assembler;
    const {source} = stream;
    const isOver = (): boolean => assembler.manifest !== manifest; // another log
    try {
      const part = await retry(
        () => fetchLaterPart(source, laterBytes, fileBytes),
        Math.random,
        (thrown) => errorCode(thrown) === 'network',
      );
      if (isOver()) return;
      assembler.takeLater(part);
      stream.receivedAside(part.length);
      coarse?.noteLater(part);
    } catch (thrown) {
      if (isOver()) return;
      const message = `${errorText(thrown).replace(/\.?$/, '.')}${kWithoutLater}`;
      reports.error(errorCode(thrown), message);
      if (reports.hasManifest) return;
    }
    recovery.guarded(() => (this.isAwaited ? this.known() : reports.manifest(true)));
  }

  /** Must be called before another log. */
  forget(): void {
    this.isAsked = false;
  }
}
