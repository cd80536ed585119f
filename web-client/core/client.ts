// The page's side of the worker: commands out, messages in. Holds no mesh.

import type {Plane} from './slice';
import type {FromWorker, Source, ToWorker} from './worker_messages';

export type Listener = (message: FromWorker) => void;

export class Client {
  private readonly worker = new Worker(new URL('./worker.ts', import.meta.url), {type: 'module', name: 'qtet'});
  private readonly digests = new Map<number, (hex: string) => void>();
  private nextDigest = 0;

  /** `listen` hears everything but the answers to `digest`. */
  constructor(listen: Listener) {
    this.worker.onmessage = (event: MessageEvent<FromWorker>) => {
      const message = event.data;
      if (message.type !== 'digest') {
        listen(message);
        return;
      }
      this.digests.get(message.id)?.(message.hex);
      this.digests.delete(message.id);
    };
    this.worker.onerror = (event) => {
      listen({type: 'error', code: 'internal', message: `The decoder stopped: ${event.message || 'unknown cause'}. Reload the page.`});
      listen({type: 'state', state: 'failed', attempt: 0, delayMs: 0});
    };
  }

  start(source: Source): void { this.post({type: 'start', source}); }
  showField(name: string): void { this.post({type: 'field', name}); }
  clip(plane: Plane | null): void { this.post({type: 'clip', plane}); }
  pause(): void { this.post({type: 'pause'}); }
  resume(): void { this.post({type: 'resume'}); }
  /** To be called once a snapshot is on the screen; the next one waits for it. */
  shown(): void { this.post({type: 'shown'}); }

  /** SHA-256 over the mesh as it stands in the worker, lower-case hexadecimal; empty before there is one. */
  digest(): Promise<string> {
    const id = this.nextDigest++;
    return new Promise((resolve) => {
      this.digests.set(id, resolve);
      this.post({type: 'digest', id});
    });
  }

  dispose(): void { this.worker.terminate(); }

  private post(message: ToWorker): void { this.worker.postMessage(message); }
}
