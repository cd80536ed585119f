// The worker. It does networking, decoding and cutting, so that the page only draws.

import {Assembler} from '../decode/assembler';
import {WasmCodec} from '../decode/codec';
import {kDraco} from '../decode/draco';
import {isForbidden, decoderFailure} from '../protocol/wasm_policy';
import {fieldsOf} from '../layers/shown';
import {derivation} from '../picture/derivation';
import type {DerivedFields} from '../picture/derived_field';
import type {Display} from '../picture/display';
import {buffersOfVolume, type CoarseCells} from '../picture/volume';
import {retry} from '../transport/retry';
import {CoarseVolume} from './coarse_volume';
import {Publisher} from './publisher';
import {Session} from './session';
import {buffersOf} from './snapshot_buffers';
import type {Answer, FromWorker, Inspected, Posted, Snapshot, ToWorker} from './worker_messages';

interface Parts {
  session: Session;
  publisher: Publisher;
  coarse: CoarseVolume;
  /** The mesh's; empty while there is none. */
  digest(): Promise<string>;
  derive(text: string): Promise<DerivedFields>;
  answer(question: Inspected): Promise<Answer>;
}

declare global {
  /** For debugging and tests. */
  var qtetPublisher: Publisher | undefined;
}

let parts: Parts;
let run: number | undefined;
/** The code for parts, lines, arrows and volumes is here, or did not come. */
let hasLateCode = false;
/** The page's last wish. */
let last: Display | null = null;

self.onmessage = (event: MessageEvent<ToWorker>) => {
  if (event.data.type === 'load') parts = start(event.data.baseUrl, event.data.codecUrl);
  else obey(parts, event.data);
};

/**
 * The session begins before its codec is here: a line takes as long to open. The base mesh is
 * decoded by a module of its own, which comes sooner.
 */
function start(baseUrl: string, codecUrl: string): Parts {
  const codec = new WasmCodec();
  const assembler = new Assembler(codec, kDraco);
  const publisher = (globalThis.qtetPublisher = new Publisher(assembler, postSnapshot));
  let whole: Promise<WebAssembly.Module> | null = null;
  const becomeWhole = async (): Promise<WebAssembly.Module> => {
    const module = await retry(() => compile(codecUrl), Math.random, mayPass);
    codec.become(module);
    session.renewed();
    retry(() => import('../picture/creases')).then(
      ({creasesOf}) => publisher.useCreases(creasesOf),
      () => undefined, // pictures stay without
    );
    return module;
  };
  const makeWhole = (): Promise<WebAssembly.Module> => (whole ??= becomeWhole());
  const coarse = new CoarseVolume(
    async () => new Assembler(new WasmCodec(await makeWhole()), kDraco),
  );
  const session = new Session(assembler, publisher, (message) => {
    post(message);
    if (message.type === 'base') makeWhole().catch(fail);
  });
  session.coarse = coarse;
  assembler.codecReady = retry(() => compile(baseUrl), Math.random, mayPass).then((module) =>
    codec.become(module),
  );
  assembler.codecReady.catch(fail);
  session.waitForCodec();
  return {
    publisher,
    coarse,
    session,
    answer: async (question) => {
      const {answerTo} = await retry(() => import('./answers'));
      return answerTo(question, assembler, publisher.now);
    },
    derive: async (text) => {
      const derived = await retry(() => import('../derived/derived'));
      Object.assign(derivation, derived.kDerivation);
      const {manifest} = assembler;
      return manifest ? derived.deriveFields(text, manifest) : {fields: [], errors: []};
    },
    digest: async () => {
      await assembler.codecReady;
      if (codec.chunkCount === 0) return '';
      await makeWhole();
      return codec.digest();
    },
  };
}

function fail(thrown: unknown): void {
  parts.session.failed(decoderFailure(thrown));
}

const mayPass = (thrown: unknown): boolean => !isForbidden(thrown);

/** Compiles while downloading. A host that serves .wasm under another type loses only that. */
async function compile(url: string): Promise<WebAssembly.Module> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: HTTP ${response.status}`);
  if (response.headers.get('content-type') === 'application/wasm')
    return WebAssembly.compileStreaming(response);
  return WebAssembly.compile(await response.arrayBuffer());
}

function obey(all: Parts, message: Exclude<ToWorker, {type: 'load'}>): void {
  const {session, publisher, coarse} = all;
  // The inspector answers all others, as the type of `answer` checks.
  // eslint-disable-next-line @typescript-eslint/switch-exhaustiveness-check
  switch (message.type) {
    case 'start':
      run = message.run;
      return session.start(message.source);
    case 'display': {
      ({display: last} = message);
      const {parts: its, streamlines, arrows, volume} = last;
      if ((its || volume || streamlines || arrows) && !hasLateCode) {
        const of = run;
        const again = (): void => {
          hasLateCode = true;
          if (of === run) obey(all, {type: 'display', display: last!});
        };
        // without lines and arrows a picture says nothing wrong
        return void retry(() => import('./late_code')).then(again, its || volume ? fail : again);
      }
      publisher.show(last);
      return session.want(fieldsOf(last), last.ahead);
    }
    case 'limit':
      return session.setLimit(message.limit);
    case 'pause':
      return session.pause();
    case 'resume':
      return session.resume();
    case 'shown':
      return publisher.shown(message.drawingMs);
    case 'repeat':
      return publisher.repeat();
    case 'derive':
      return reply(message, all.derive(message.text));
    case 'digest':
      return reply(message, all.digest());
    case 'coarse': {
      const {id, have} = message;
      const send = (answer: CoarseCells | null): void =>
        self.postMessage({type: 'answer', id, answer} satisfies FromWorker, {
          transfer: answer?.cells ? buffersOfVolume(answer.cells) : [],
        });
      return void coarse.cells(have, publisher.now).then(send, () => send(null));
    }
    default:
      return reply(message, all.answer(message));
  }
}

function reply({id}: {id: number}, coming: Promise<Answer>): void {
  coming.then((answer) => post({type: 'answer', id, answer}), fail);
}

function post(message: FromWorker): void {
  self.postMessage({...message, run});
}

function postSnapshot(snapshot: Snapshot): void {
  const message: Posted = {type: 'snapshot', snapshot, run: run!};
  self.postMessage(message, {transfer: buffersOf(snapshot)});
}
