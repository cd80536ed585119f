// A series whose later instants come behind the first picture, over byte ranges. Needs the built
// codec, which QTET_WASM names (ctest sets it).

import {readFileSync} from 'node:fs';
import {afterEach, beforeEach, describe, expect, test, vi} from 'vitest';
import {Assembler} from '../core/decode/assembler';
import {WasmCodec} from '../core/decode/codec';
import {kDraco} from '../core/decode/draco';
import {fieldKeys} from '../core/protocol/fields';
import {kFull} from '../core/protocol/limit';
import {timesOf} from '../core/protocol/series';
import {Publisher} from '../core/session/publisher';
import {Session} from '../core/session/session';
import type {FromWorker, Source} from '../core/session/worker_messages';
import {headBytesOf} from '../core/transport/block_source';
import {errorsOf, statesOf, until} from './fakes';
import {kTestWasm} from './whole_log';

const kSeries = new URL('../../tests/golden/valid/series.qtet', import.meta.url);
type Sent = Extract<FromWorker, {type: 'manifest'}>;

describe.skipIf(kTestWasm === '')('later instants', () => {
  const log = new Uint8Array(readFileSync(kSeries));
  const module = WebAssembly.compile(readFileSync(kTestWasm));
  let received: FromWorker[];
  let asked: string[];
  let session: Session;
  let assembler: Assembler;
  /** Refuses the requests for the end of the file. */
  let isEndLost: boolean;

  beforeEach(async () => {
    received = [];
    asked = [];
    isEndLost = false;
    vi.stubGlobal('fetch', (_url: string, init: RequestInit) => {
      const range = new Headers(init.headers).get('range')!;
      asked.push(range);
      const [, from, to] = /^bytes=(\d*)-(\d*)$/.exec(range)!;
      if (isEndLost && Number(to) === log.length - 1)
        return Promise.resolve(new Response(null, {status: 404, statusText: 'lost'}));
      const bytes = log.slice(Number(from), Number(to) + 1);
      const headers = {'content-range': `bytes ${from}-${to}/${log.length}`};
      return Promise.resolve(new Response(bytes, {status: 206, headers}));
    });
    assembler = new Assembler(new WasmCodec(await module), kDraco);
    const publisher = new Publisher(assembler, () => undefined);
    session = new Session(assembler, publisher, (message) => received.push(message));
  });
  afterEach(() => {
    session.pause();
    vi.unstubAllGlobals();
  });

  const manifests = (): Sent[] =>
    received.filter((message): message is Sent => message.type === 'manifest');
  const start = (source: Partial<Source> = {}): void =>
    session.start({
      url: '',
      log: 'http://x/series.qtet',
      transport: 'range',
      mesh: 'm',
      fields: null,
      limit: kFull,
      firstBytes: headBytesOf(log),
      ...source,
    });

  test('comeOnceTheFirstFieldIsHere', async () => {
    start();
    await until(() => manifests().length === 2);
    const [first, more] = manifests();
    expect([first!.isMore, more!.isMore]).toEqual([undefined, true]);
    expect(asked.some((range) => range.endsWith(`-${log.length - 1}`))).toBe(true);
    const {fields, later} = assembler.manifest!;
    expect(later).toBe(0);
    expect(timesOf(fields).length).toBeGreaterThan(5);
    expect(fields.map(({instant}) => instant?.series)).not.toContain(undefined);
    session.want([fields.length - 1]);
    await until(() => assembler.wholeFields.includes(fields.length - 1));
    expect(errorsOf(received)).toEqual([]);
  });

  test.each([
    [{fields: ['T'], time: 2.5}, 'T@2.5'],
    [{fields: ['T@2.5']}, 'T@2.5'],
    [{fields: ['C@0']}, 'C@0'], // which is predicted from none
  ])('comeBeforeTheManifestIf %o isAskedFor', async (source, key) => {
    start(source);
    await until(() => statesOf(received).includes('complete'));
    expect(manifests()).toHaveLength(1);
    const [{manifest, fields}] = manifests() as [Sent];
    expect(manifest.later).toBe(0);
    expect(fields.map((field) => fieldKeys(manifest.fields)[field])).toEqual([key]);
    expect(errorsOf(received)).toEqual([]);
  });

  test('areMissedIfTheyCannotBeFetched', async () => {
    isEndLost = true;
    start();
    await until(() => errorsOf(received).length === 1);
    await until(() => statesOf(received).includes('complete'));
    expect(assembler.manifest!.fields).toHaveLength(1);
    start({time: 2.5});
    await until(() => manifests().length === 2);
    await until(() => statesOf(received).at(-1) === 'complete');
  });
});
