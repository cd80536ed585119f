// The worker: network, decoding and cutting happen here, so that the page only draws.

import codecUrl from 'qtet-codec.wasm?url';
import {Assembler} from './assembler';
import {WasmCodec} from './codec';
import {kDraco} from './draco';
import {errorText} from './errors';
import {Publisher} from './publisher';
import {retry} from './retry';
import {Session} from './session';
import type {FromWorker, Snapshot, ToWorker} from './worker_messages';

interface Parts {
  session: Session;
  publisher: Publisher;
  codec: WasmCodec;
}

const parts = start();
parts.catch((thrown: unknown) => {
  post({type: 'error', code: 'internal', message: `The decoder could not be loaded (${errorText(thrown)}). Reload the page.`});
  post({type: 'state', state: 'failed', attempt: 0, delayMs: 0});
});

self.onmessage = (event: MessageEvent<ToWorker>) => {
  // Commands keep their order: each waits for the same promise.
  parts.then((ready) => obey(ready, event.data)).catch(() => undefined);
};

async function start(): Promise<Parts> {
  const codec = await WasmCodec.create(await retry(() => compile(codecUrl)));
  const assembler = new Assembler(codec, kDraco);
  const publisher = new Publisher(assembler, postSnapshot);
  return {codec, publisher, session: new Session(assembler, publisher, post)};
}

/** Compiles while it downloads; a host that serves .wasm under another type costs only that. */
async function compile(url: string): Promise<WebAssembly.Module> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: HTTP ${response.status}`);
  if (response.headers.get('content-type') === 'application/wasm') return WebAssembly.compileStreaming(response);
  return WebAssembly.compile(await response.arrayBuffer());
}

function obey({session, publisher, codec}: Parts, message: ToWorker): void {
  switch (message.type) {
    case 'start': return session.start(message.source);
    case 'field': return session.showField(message.name);
    case 'clip': return publisher.clip(message.plane);
    case 'pause': return session.pause();
    case 'resume': return session.resume();
    case 'shown': return publisher.shown();
    case 'digest': return post({type: 'digest', id: message.id, hex: codec.chunkCount > 0 ? codec.digest() : ''});
  }
}

function post(message: FromWorker): void {
  self.postMessage(message);
}

function postSnapshot(snapshot: Snapshot): void {
  const soups = [snapshot.surface, snapshot.cut?.cap].filter((soup) => soup !== undefined);
  const buffers = soups.flatMap((soup) => [soup.positions.buffer, soup.values.buffer]) as ArrayBuffer[];
  const message: FromWorker = {type: 'snapshot', snapshot};
  self.postMessage(message, {transfer: buffers});
}
