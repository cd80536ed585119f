// The worker. It does networking, decoding and cutting, so that the page only draws.

import {Assembler} from '../decode/assembler';
import {WasmCodec} from '../decode/codec';
import {kDraco} from '../decode/draco';
import {fieldsOf} from '../layers/shown';
import {buffersOfVolume, type CoarseCells} from '../picture/volume';
import {errorText} from '../protocol/errors';
import {retry} from '../transport/retry';
import {CoarseVolume} from './coarse_volume';
import {Inspector} from './inspector';
import {Publisher} from './publisher';
import {Session} from './session';
import {buffersOf} from './snapshot_buffers';
import type {FromWorker, Posted, Snapshot, ToWorker} from './worker_messages';

interface Parts {
  session: Session;
  publisher: Publisher;
  coarse: CoarseVolume;
  /** The mesh's; empty while there is none. */
  digest(): Promise<string>;
  inspector: Inspector;
}

declare global {
  /** For debugging and tests. */
  var qtetPublisher: Publisher | undefined;
}

let parts: Promise<Parts>;
let run: number | undefined;

self.onmessage = (event: MessageEvent<ToWorker>) => {
  if (event.data.type === 'load') {
    parts = start(event.data.baseUrl, event.data.codecUrl);
    parts.catch(fail);
    return;
  }
  // Commands keep their order: each waits for the same promise.
  const message = event.data;
  parts.then((ready) => obey(ready, message)).catch(() => undefined);
};

/** The base mesh is decoded by a module of its own, which is here sooner. */
async function start(baseUrl: string, codecUrl: string): Promise<Parts> {
  const codec = await WasmCodec.create(await retry(() => compile(baseUrl)));
  const assembler = new Assembler(codec, kDraco);
  const publisher = (globalThis.qtetPublisher = new Publisher(assembler, postSnapshot));
  let whole: Promise<WebAssembly.Module> | null = null;
  const becomeWhole = async (): Promise<WebAssembly.Module> => {
    const module = await retry(() => compile(codecUrl));
    codec.become(module);
    session.renewed();
    return module;
  };
  const makeWhole = (): Promise<WebAssembly.Module> => (whole ??= becomeWhole());
  const coarse = new CoarseVolume(
    async () => new Assembler(await WasmCodec.create(await makeWhole()), kDraco),
  );
  const session = new Session(assembler, publisher, post);
  session.coarse = coarse;
  session.onBase = () => void makeWhole().catch(fail);
  return {
    publisher,
    coarse,
    session,
    inspector: new Inspector(assembler),
    digest: async () => {
      if (codec.chunkCount === 0) return '';
      await makeWhole();
      return codec.digest();
    },
  };
}

function fail(thrown: unknown): void {
  post({
    type: 'error',
    code: 'internal',
    message: `The decoder could not be loaded (${errorText(thrown)}). Reload the page.`,
  });
  post({type: 'state', state: 'failed', attempt: 0, delayMs: 0});
}

/** Compiles while downloading. A host that serves .wasm under another type loses only that. */
async function compile(url: string): Promise<WebAssembly.Module> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: HTTP ${response.status}`);
  if (response.headers.get('content-type') === 'application/wasm')
    return WebAssembly.compileStreaming(response);
  return WebAssembly.compile(await response.arrayBuffer());
}

function obey(
  {session, publisher, coarse, inspector, ...its}: Parts,
  message: Exclude<ToWorker, {type: 'load'}>,
): void {
  switch (message.type) {
    case 'start':
      run = message.run;
      return session.start(message.source);
    case 'display':
      publisher.show(message.display);
      return session.want(fieldsOf(message.display));
    case 'limit':
      return session.setLimit(message.limit);
    case 'look':
      return session.look(message.view);
    case 'pause':
      return session.pause();
    case 'resume':
      return session.resume();
    case 'shown':
      return publisher.shown(message.drawingMs);
    case 'repeat':
      return publisher.repeat();
    case 'digest':
      return void its
        .digest()
        .then((answer) => post({type: 'answer', id: message.id, answer}), fail);
    case 'pick':
      return post({
        type: 'answer',
        id: message.id,
        answer: inspector.pick(message.ray, publisher.display),
      });
    case 'probe':
      return post({
        type: 'answer',
        id: message.id,
        answer: inspector.probe(message.from, message.to, publisher.display),
      });
    case 'line':
      return post({
        type: 'answer',
        id: message.id,
        answer: inspector.line(message.from, message.to, publisher.display),
      });
    case 'histogram':
      return post({
        type: 'answer',
        id: message.id,
        answer: inspector.histogram(message.axis, publisher.display),
      });
    case 'coarse': {
      const {id, have} = message;
      const reply = (answer: CoarseCells | null): void =>
        self.postMessage({type: 'answer', id, answer} satisfies FromWorker, {
          transfer: answer?.cells ? buffersOfVolume(answer.cells) : [],
        });
      return void coarse.cells(have, publisher.display).then(reply, () => reply(null));
    }
  }
}

function post(message: FromWorker): void {
  self.postMessage({...message, run});
}

function postSnapshot(snapshot: Snapshot): void {
  const message: Posted = {type: 'snapshot', snapshot, run: run!};
  self.postMessage(message, {transfer: buffersOf(snapshot)});
}
