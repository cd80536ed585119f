// The wanted part of a log, and how far receiving and decoding have come.

import type {Assembler} from '../decode/assembler';
import type {Statistics} from '../decode/statistics';
import {errorOfLevel, kFull, limitReached, type Limit} from '../protocol/limit';
import {fieldKeys} from '../protocol/fields';
import type {OpenRequest, Target} from '../protocol/messages';
import {fieldOfSeries, showTime, shownInstant} from '../protocol/series';
import type {Source} from './worker_messages';

/** How far the shown part has come. Each state includes the ones before. */
export enum Progress {
  /** Blocks up to the limit are missing, of the mesh or of a field. */
  missing,
  /** They are here. */
  received,
  /** The mesh has reached the limit, or the end of a cut log. */
  settled,
  /** The fields have, too: no other picture follows by itself. */
  decoded,
  /** The whole mesh is decoded with the fields. */
  complete,
}

export class RequestedPart {
  /**
   * Names of the fields, for use before the head says which there are; null means the opening's.
   */
  names: string[] | null = null;
  /** Indexes into the manifest: the fields that are shown. */
  fields: readonly number[] = [];
  /** Fields that may be shown soon. They come and are decoded behind all else. */
  ahead: readonly number[] = [];
  /** Something ahead has failed: each field waits until it is shown. */
  isAheadEnded = false;
  limit: Limit = kFull;
  /** Some names mean series, and only the head says which instants these have. */
  private hasSeries = false;
  /** The time that series begin with; null: that of the instants in the head. */
  private time: number | null = null;
  /** The chunks that the log's copy holds. */
  private chunks = Infinity;

  constructor(private readonly assembler: Assembler) {}

  begin({fields, hasSeries = false, limit, time = null, chunks = Infinity}: Source): void {
    this.hasSeries = hasSeries;
    this.time = time;
    this.names = fields;
    this.limit = limit;
    this.chunks = chunks;
  }

  /** Must be called before another log. */
  forget(): void {
    this.fields = this.ahead = [];
    this.isAheadEnded = false;
  }

  changeAhead(fields: readonly number[]): void {
    if (!this.isAheadEnded) this.ahead = fields;
  }

  /** Returns false if that was done before. */
  endAhead(): boolean {
    const {isAheadEnded} = this;
    this.ahead = [];
    this.isAheadEnded = true;
    return !isAheadEnded;
  }

  /** Fields that the shown mesh does not need are decoded. */
  get hasOthers(): boolean {
    const {codec, manifest} = this.assembler;
    const isOther = (field: number): boolean =>
      codec.fieldChunksApplied(field) > 0 && !this.shows(field);
    return manifest?.fields.some((_, field) => isOther(field)) === true;
  }

  /** Whether the shown mesh needs this field. */
  shows(field: number): boolean {
    return this.assembler.parents.order(this.fields).includes(field);
  }

  /** All fields that have to come, those that others are predicted from among them. */
  private get needed(): readonly number[] {
    return this.assembler.parents.order([...this.fields, ...this.ahead]);
  }

  /**
   * Finds the fields by their names. The first field replaces an unknown name, which is returned.
   * REQUIRES: the head is here.
   */
  findFields(): string | undefined {
    const {fields, opening} = this.assembler.manifest!;
    const keys = fieldKeys(fields);
    showTime(fields, this.time);
    const fieldOf = (name: string): number =>
      keys.includes(name) ? keys.indexOf(name) : fieldOfSeries(fields, name);
    const unknown = this.names?.find((name) => fieldOf(name) < 0);
    this.fields = (this.names ?? []).map(fieldOf).filter((field) => field >= 0);
    const wantsFirst = this.names === null || unknown !== undefined;
    if (this.fields.length === 0 && keys.length > 0 && wantsFirst)
      this.fields = [shownInstant(fields, opening?.field ?? 0)];
    return unknown;
  }

  /** Returns false if these are wanted already. REQUIRES: the head is here. */
  changeFields(fields: readonly number[]): boolean {
    const {fields: now} = this;
    if (fields.length === now.length && fields.every((field) => now.includes(field))) return false;
    this.fields = fields;
    const keys = fieldKeys(this.assembler.manifest!.fields);
    this.names = fields.map((field) => keys[field]!);
    return true;
  }

  /** The server's keys of the fields. */
  get keys(): string[] {
    const {manifest} = this.assembler;
    if (!manifest) return this.hasSeries ? [] : (this.names ?? []);
    const keys = fieldKeys(manifest.fields);
    return this.needed.map((field) => keys[field]!);
  }

  get statistics(): Statistics {
    return this.assembler.statistics(this.fields);
  }

  /** Where the limit lies; null means at the end, or unknown. */
  get target(): Target | null {
    const target = this.assembler.target(this.limit, this.fields);
    const {chunks} = this;
    if (chunks === Infinity || (target && target.chunks <= chunks)) return target;
    return {chunks, level: this.assembler.manifest?.levels.at(-1)?.level ?? 0};
  }

  /** Only the head says which fields there are or where the limit lies. */
  get needsHead(): boolean {
    const mayEnd = this.limit.kind !== 'full' || this.chunks < Infinity;
    return !this.assembler.manifest && (this.names === null || this.hasSeries || mayEnd);
  }

  get progress(): Progress {
    const {codec, manifest} = this.assembler;
    const {chunksApplied, chunkCount} = codec;
    const areDecoded = this.fields.every(
      (field) => codec.fieldChunksApplied(field) === chunksApplied,
    );
    if (manifest && chunksApplied >= chunkCount && areDecoded) return Progress.complete;
    if (!this.isReceived) return Progress.missing;
    if (!this.isReached) return Progress.received;
    return areDecoded ? Progress.decoded : Progress.settled;
  }

  /** All blocks up to the limit are here with the fields. */
  private get isReceived(): boolean {
    const {assembler} = this;
    const chunks = this.target?.chunks ?? assembler.codec.chunkCount;
    return (
      assembler.manifest !== null &&
      assembler.receivedChunks >= chunks &&
      assembler.parents
        .order(this.fields)
        .every((field) => assembler.receivedOfField(field) >= chunks)
    );
  }

  /** The fields ahead are here for the decoded mesh. */
  get isAheadReceived(): boolean {
    const {assembler} = this;
    const chunks = assembler.codec.chunksApplied;
    return this.needed.every((field) => assembler.receivedOfField(field) >= chunks);
  }

  /** The decoded mesh has reached the limit, or the end of a cut log. */
  get isReached(): boolean {
    const {codec, manifest} = this.assembler;
    if (manifest && codec.chunksApplied >= this.chunks) return true;
    if (this.limit.kind === 'full' || !manifest || codec.chunksApplied === 0) return false;
    const {statistics, fields} = this;
    const error = errorOfLevel(manifest.levels, statistics.level, fields);
    return limitReached(this.limit, statistics, error);
  }

  /** The `have` of an `open` message. */
  get have(): OpenRequest['have'] {
    const {assembler, keys} = this;
    if (!assembler.manifest) return {chunks: 0, fields: {}};
    const fields = this.needed.map(
      (field, i) => [keys[i]!, assembler.receivedOfField(field)] as const,
    );
    return {chunks: assembler.receivedChunks, fields: Object.fromEntries(fields)};
  }
}
