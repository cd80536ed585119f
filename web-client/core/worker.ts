// The worker: network, decoding and cutting happen here, so that the page only draws.

import {Assembler} from './assembler';
import {WasmCodec} from './codec';
import {kDraco} from './draco';
import {fieldsOf} from './display';
import {errorText} from './errors';
import {Inspector} from './inspector';
import {Publisher} from './publisher';
import {retry} from './retry';
import {Session} from './session';
import type {FromWorker, Snapshot, ToWorker} from './worker_messages';

interface Parts {
  session: Session;
  publisher: Publisher;
  codec: WasmCodec;
  inspector: Inspector;
}

let parts: Promise<Parts>;

self.onmessage = (event: MessageEvent<ToWorker>) => {
  if (event.data.type === 'load') {
    parts = start(event.data.codecUrl);
    parts.catch((thrown: unknown) => {
      post({type: 'error', code: 'internal', message: `The decoder could not be loaded (${errorText(thrown)}). Reload the page.`});
      post({type: 'state', state: 'failed', attempt: 0, delayMs: 0});
    });
    return;
  }
  // Commands keep their order: each waits for the same promise.
  const message = event.data;
  parts.then((ready) => obey(ready, message)).catch(() => undefined);
};

async function start(codecUrl: string): Promise<Parts> {
  const codec = await WasmCodec.create(await retry(() => compile(codecUrl)));
  const assembler = new Assembler(codec, kDraco);
  const publisher = new Publisher(assembler, postSnapshot);
  return {codec, publisher, inspector: new Inspector(assembler), session: new Session(assembler, publisher, post)};
}

/** Compiles while it downloads; a host that serves .wasm under another type costs only that. */
async function compile(url: string): Promise<WebAssembly.Module> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: HTTP ${response.status}`);
  if (response.headers.get('content-type') === 'application/wasm') return WebAssembly.compileStreaming(response);
  return WebAssembly.compile(await response.arrayBuffer());
}

function obey({session, publisher, codec, inspector}: Parts, message: Exclude<ToWorker, {type: 'load'}>): void {
  switch (message.type) {
    case 'start': return session.start(message.source);
    case 'display':
      publisher.show(message.display);
      return session.want(fieldsOf(message.display));
    case 'limit': return session.setLimit(message.limit);
    case 'look': return session.look(message.wishes);
    case 'pause': return session.pause();
    case 'resume': return session.resume();
    case 'shown': return publisher.shown();
    case 'digest': return post({type: 'answer', id: message.id, answer: codec.chunkCount > 0 ? codec.digest() : ''});
    case 'pick': return post({type: 'answer', id: message.id, answer: inspector.pick(message.ray, publisher.display)});
    case 'probe': return post({type: 'answer', id: message.id, answer: inspector.probe(message.from, message.to, publisher.display)});
    case 'order': {
      const answer = publisher.volume.order(message.eye);
      return self.postMessage({type: 'answer', id: message.id, answer} satisfies FromWorker, {transfer: [answer.order.buffer as ArrayBuffer]});
    }
  }
}

function post(message: FromWorker): void {
  self.postMessage(message);
}

function postSnapshot(snapshot: Snapshot): void {
  const soups = [snapshot.surface, ...(snapshot.cuts ?? []), snapshot.isosurface].filter((soup) => soup !== undefined);
  const buffers = soups.flatMap((soup) => [soup.positions.buffer, soup.values.buffer]) as ArrayBuffer[];
  const {volume} = snapshot;
  if (volume) buffers.push(...[volume.vertices.buffer, volume.cells.buffer, ...(volume.cellValues ? [volume.cellValues.buffer] : [])] as ArrayBuffer[]);
  const message: FromWorker = {type: 'snapshot', snapshot};
  self.postMessage(message, {transfer: buffers});
}
