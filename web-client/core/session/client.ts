// The page's side of the worker: commands out, messages in. Holds no mesh.

import baseUrl from 'qtet-base.wasm?url';
import codecUrl from 'qtet-codec.wasm?url';
import type {Ray} from '../picture/cell_ray';
import type {DerivedFields} from '../picture/derived_field';
import type {Display} from '../picture/display';
import type {Axis, Histogram} from '../picture/histogram';
import type {LineSoup} from '../picture/streamlines';
import type {PartCount} from '../picture/part_counts';
import type {CoarseCells} from '../picture/volume';
import type {Vector} from '../protocol/geometry';
import type {Limit} from '../protocol/limit';
import type {KeptPlaces, KeptValues, LineValues, Numbers, Pick, Probe} from './inspector';
import {
  kNoSource,
  type FromWorker,
  type Posted,
  type Question,
  type Source,
  type ToWorker,
} from './worker_messages';

export type Listener = (message: Exclude<FromWorker, {type: 'answer'}>) => void;

export class Client {
  private readonly worker = new Worker(new URL('./worker.ts', import.meta.url), {
    type: 'module',
    name: 'qtet',
  });
  private readonly asked = new Map<number, (answer: never) => void>();
  private nextId = 0;
  private run = 0;

  constructor(listen: Listener) {
    // The page knows where its build put the codec. The worker's own file may have moved without
    // the files that it refers to.
    const [base, codec] = [baseUrl, codecUrl].map((url) => new URL(url, import.meta.url).href);
    this.post({type: 'load', baseUrl: base!, codecUrl: codec!});
    this.worker.onmessage = (event: MessageEvent<Posted>) => {
      const message = event.data;
      if (message.type !== 'answer') {
        if (message.run === undefined || message.run === this.run) listen(message);
        return;
      }
      this.asked.get(message.id)?.(message.answer as never);
      this.asked.delete(message.id);
    };
    this.worker.onerror = (event) => {
      listen({
        type: 'error',
        code: 'internal',
        message: `The decoder stopped: ${event.message || 'unknown cause'}. Reload the page.`,
      });
      listen({type: 'state', state: 'failed', attempt: 0, delayMs: 0});
    };
  }

  /**
   * `url` and `mesh` must be given, or `log` alone. By default the session takes the first field,
   * no limit, and any transport that works. Messages of an earlier start are dropped.
   */
  start(source: Partial<Source>): void {
    this.post({type: 'start', source: {...kNoSource, ...source}, run: ++this.run});
  }
  /**
   * REQUIRES: the display's fields are in the last `manifest` message. Fields that are missing are
   * fetched.
   */
  show(display: Display): void {
    this.post({type: 'display', display});
  }
  setLimit(limit: Limit): void {
    this.post({type: 'limit', limit});
  }
  pause(): void {
    this.post({type: 'pause'});
  }
  resume(): void {
    this.post({type: 'resume'});
  }
  /**
   * Must be called when a snapshot is on the screen; the next one waits for it. `drawingMs` says
   * how long drawing took, if known.
   */
  shown(drawingMs?: number): void {
    this.post({type: 'shown', drawingMs});
  }
  /** Asks for the whole picture again, because its receiver is gone. */
  repeat(): void {
    this.post({type: 'repeat'});
  }

  /** SHA-256 of the mesh in the worker, lower-case hexadecimal; empty before there is a mesh. */
  digest(): Promise<string> {
    return this.ask({type: 'digest'});
  }
  /** The fields that a text defines (core/derived), and those that the mesh implies. */
  derive(text: string): Promise<DerivedFields> {
    return this.ask({type: 'derive', text});
  }
  pick(ray: Ray): Promise<Pick | null> {
    return this.ask({type: 'pick', ray});
  }
  trace(cell: number, place: Vector): Promise<LineSoup | null> {
    return this.ask({type: 'trace', cell, place});
  }
  probe(from: Vector, to: Vector): Promise<Probe | null> {
    return this.ask({type: 'probe', from, to});
  }
  /** All fields that are here along a line; empty if it meets no cell. */
  line(from: Vector, to: Vector): Promise<LineValues[]> {
    return this.ask({type: 'line', from, to});
  }
  /** Inspector.at: what lies at a lattice place of the mesh at rest. */
  at(place: Vector): Promise<Pick | null> {
    return this.ask({type: 'at', place});
  }
  /** Inspector.values: by field its values at a lattice place. */
  values(place: Vector, fields: readonly number[]): Promise<number[][]> {
    return this.ask({type: 'values', place, fields});
  }
  /** Counts the values of the coloured field, as they are now; null while there are none. */
  histogram(axis: Axis): Promise<Histogram | null> {
    return this.ask({type: 'histogram', axis});
  }

  /** The parts that a label makes of the whole mesh; null while it has no values. */
  parts(field: number): Promise<PartCount[] | null> {
    return this.ask({type: 'parts', field});
  }

  /** Inspector.kept; null while there is no mesh. */
  kept(places: KeptPlaces): Promise<KeptValues | null> {
    return this.ask({type: 'kept', places});
  }

  /** Integrals over what is drawn; null while there is no mesh. */
  numbers(): Promise<Numbers | null> {
    return this.ask({type: 'numbers'});
  }

  /**
   * The last snapshot's volume with few cells. The cells are left out if the caller has version
   * `have`. Rejects if there are none.
   */
  async coarse(have: number): Promise<CoarseCells> {
    const answer = await this.ask<CoarseCells | null>({type: 'coarse', have});
    if (!answer) throw new Error('there are no coarse cells');
    return answer;
  }

  dispose(): void {
    this.worker.terminate();
  }

  private ask<Answer>(question: Question): Promise<Answer> {
    const id = this.nextId++;
    return new Promise((resolve) => {
      this.asked.set(id, resolve);
      this.post({...question, id});
    });
  }

  private post(message: ToWorker): void {
    this.worker.postMessage(message);
  }
}
