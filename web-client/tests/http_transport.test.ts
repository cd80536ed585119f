// Ranges and numbered chunks against a web server of a few lines, whose files are arrays and whose
// answers are functions.

import {afterEach, beforeEach, describe, expect, test, vi} from 'vitest';
import {Assembler} from '../core/decode/assembler';
import {AutoTransport, type TransportKind} from '../core/transport/auto_transport';
import {kLongestDelayMs} from '../core/transport/backoff';
import {ChunkSource, RangeSource} from '../core/transport/block_source';
import {HttpTransport, piecesOf} from '../core/transport/http_transport';
import {kFull} from '../core/protocol/limit';
import {Publisher} from '../core/session/publisher';
import type {Fetch} from '../core/transport/ranged_file';
import {Session} from '../core/session/session';
import {SocketTransport} from '../core/transport/socket_transport';
import {kindsOf} from '../core/transport/transports';
import type {FromWorker} from '../core/session/worker_messages';
import {
  errorsOf,
  FakeCodec,
  FakeSocket,
  fakeHead,
  headFrame,
  kFakeBlockBytes,
  kFakeValues,
  meshFrame,
  statesOf,
  type FakeLog,
} from './fakes';

const kLog: FakeLog = {fields: ['p', 'v'], chunks: 40};
/** It has more bytes than the first request and the next ones ask for. */
const kLongLog = {...kLog, blockBytes: 1000};
const kParts = 4;
const kSha = 'a'.repeat(64);

/** A log as a file; its blocks are zeros. */
function file(log: FakeLog): Uint8Array {
  const head = fakeHead(log);
  const bytes = new Uint8Array(
    head.length + log.chunks * kParts * (log.blockBytes ?? kFakeBlockBytes),
  );
  bytes.set(head);
  return bytes;
}

interface Host {
  fetch: Fetch;
  asked: string[];
  tag: string;
  ranges: boolean;
  /** How many of the next answers fail. */
  broken: number;
}

function host(bytes: () => Uint8Array): Host {
  const it: Host = {
    asked: [],
    tag: '"t1"',
    ranges: true,
    broken: 0,
    fetch: async (url, init) => {
      const range = new Headers(init.headers).get('range');
      it.asked.push(range ?? url);
      if (it.broken > 0 && it.broken-- > 0) throw new TypeError('network');
      const all = bytes();
      const [, from, to] = /bytes=(\d+)-(\d+)/.exec(range ?? '') ?? [];
      const headers = {etag: it.tag, 'content-range': `bytes ${from}-${to}/${all.length}`};
      if (range && it.ranges)
        return new Response(all.slice(Number(from), Number(to) + 1), {status: 206, headers});
      const chunk = /(?:fields\/(\w+)\/)?chunks\/(\d+)$/.exec(url);
      if (!chunk)
        return new Response(
          all.slice(
            0,
            url.endsWith('base') ? fakeHead(kLog).length + 2 * kFakeBlockBytes : undefined,
          ),
          {headers: {etag: it.tag}},
        );
      const part = chunk[1] ? 2 + kLog.fields.indexOf(chunk[1]) : 0;
      const at = fakeHead(kLog).length + (kParts * Number(chunk[2]) + part) * kFakeBlockBytes;
      return new Response(all.slice(at, at + (part === 0 ? 2 : 1) * kFakeBlockBytes), {
        headers: {etag: it.tag},
      });
    },
  };
  return it;
}

let codec: FakeCodec;
let assembler: Assembler;
let received: FromWorker[];

beforeEach(() => {
  vi.useFakeTimers();
  received = [];
  expectLog(kLog);
});
afterEach(() => void vi.useRealTimers());

function expectLog(log: FakeLog): void {
  codec = new FakeCodec(log);
  assembler = new Assembler(codec, kFakeValues);
}

function session(
  it: Host,
  kind: 'range' | 'chunks',
  fields: string[] | null = ['p'],
  firstBytes?: number,
): Session {
  const made = new Session(
    assembler,
    new Publisher(assembler, () => undefined),
    (message) => received.push(message),
    ({log}, table, handlers) =>
      new HttpTransport(
        () =>
          kind === 'range'
            ? new RangeSource(log, table, it.fetch, firstBytes)
            : new ChunkSource(log, table, it.fetch),
        table,
        handlers,
        () => 0,
      ),
  );
  made.start({
    url: '',
    log: 'https://x/v1/meshes/m/log',
    transport: 'auto',
    mesh: 'm',
    fields,
    limit: kFull,
  });
  return made;
}

const settle = (ms = 200): Promise<unknown> => vi.advanceTimersByTimeAsync(ms);
const states = (): string[] => statesOf(received);
const errors = (): string[] => errorsOf(received);

describe('ranges', () => {
  test('aFileOnAnyWebServerComesWholeInFewRequests', async () => {
    const it = host(() => file(kLog));
    session(it, 'range', null);
    await settle();
    expect(states().at(-1)).toBe('complete');
    expect(codec.chunksApplied).toBe(kLog.chunks);
    expect(it.asked).toEqual(['bytes=0-65535']);
  });

  test('theFirstRequestTakesWhatAListSaysWithinBounds', async () => {
    const kMax = 1 << 20;
    for (const [firstBytes, asked] of [
      [63, 64],
      [64, 64],
      [65, 65],
      [kMax, kMax],
      [kMax + 1, kMax],
    ] as const) {
      expectLog(kLog);
      const it = host(() => file(kLog));
      session(it, 'range', null, firstBytes);
      await settle();
      expect(it.asked[0]).toBe(`bytes=0-${asked - 1}`);
      expect(states().at(-1)).toBe('complete');
    }
  });

  test('aServerThatKnowsNoRangesGivesTheWhole', async () => {
    const it = host(() => file(kLog));
    it.ranges = false;
    session(it, 'range');
    await settle();
    expect(states().at(-1)).toBe('complete');
    expect(it.asked).toHaveLength(1);
  });

  test('whatComesBehindTheFirstAnswerIsAskedForByItsPlace', async () => {
    expectLog(kLongLog);
    const bytes = file(kLongLog);
    const it = host(() => bytes);
    session(it, 'range');
    await settle(1000);
    expect(states().at(-1)).toBe('complete');
    expect(it.asked[1]).toMatch(/^bytes=65536-/);
    const last = Number(/-(\d+)$/.exec(it.asked.at(-1)!)![1]);
    // nobody asked for the other field's last block
    expect(last).toBe(bytes.length - kLongLog.blockBytes - 1);
  });

  test('whatLiesBehindTheTargetIsNotFetchedBeforeItIsRequested', async () => {
    const log = {...kLongLog, chunks: 90};
    expectLog(log);
    const bytes = file(log);
    const it = host(() => bytes);
    const made = session(it, 'range');
    made.setLimit({kind: 'cells', value: 40});
    await settle(1000);
    expect(states().at(-1)).toBe('held');
    const end = fakeHead(log).length + 40 * kParts * log.blockBytes;
    const fetched = (): number =>
      Math.max(...it.asked.map((range) => Number(/-(\d+)$/.exec(range)![1])));
    expect(fetched()).toBeLessThan(end);
    made.setLimit(kFull);
    await settle(1000);
    expect(states().at(-1)).toBe('complete');
    expect(fetched()).toBeGreaterThan(bytes.length - 2 * kParts * log.blockBytes);
  });

  test('aLostLineIsTriedAgainAndGoesOnWhereItWas', async () => {
    const it = host(() => file(kLog));
    it.broken = 1;
    session(it, 'range');
    await settle(50);
    expect(states()).toContain('reconnecting');
    await settle(kLongestDelayMs);
    expect(states().at(-1)).toBe('complete');
  });

  test('anotherFileInItsPlaceIsNoticedAndReadFromTheStart', async () => {
    expectLog(kLongLog);
    const it = host(() => file(kLongLog));
    const inner = it.fetch;
    it.fetch = (url, init) => {
      if (it.asked.length === 1) it.tag = '"t2"';
      return inner(url, init);
    };
    session(it, 'range');
    await settle(1000);
    expect(it.asked.filter((range) => range === 'bytes=0-65535')).toHaveLength(2);
    expect(states().at(-1)).toBe('complete');
  });

  test('aFileThatTookItsPlaceDuringAPauseIsReadFromTheStart', async () => {
    const it = host(() => file(kLog));
    it.tag = `"${kSha}"`;
    const inner = it.fetch;
    it.fetch = (url, init) => {
      if (it.asked.length === 10 && it.tag.includes(kSha)) made.pause();
      return inner(url, init);
    };
    const made = session(it, 'chunks');
    await settle();
    expect([codec.chunksApplied > 0, codec.chunksApplied < 10, states().at(-1)]).toEqual([
      true,
      true,
      'paused',
    ]);
    it.tag = `"${'b'.repeat(64)}"`;
    it.asked = [];
    made.resume();
    await settle(5000);
    expect(it.asked.slice(0, 3).map((url) => url.replace(/.*\/m\//, ''))).toEqual([
      'base',
      'base',
      'chunks/0',
    ]); // which log it is, and then all of it again
    await settle(5000);
    expect([codec.chunksApplied, errors(), states().at(-1)]).toEqual([40, [], 'complete']);
  });

  test('aPageInsteadOfALogIsSaidToBeNone', async () => {
    session(
      host(() => new TextEncoder().encode(`<html>${' '.repeat(100)}`)),
      'range',
    );
    await settle();
    expect(errors()).toEqual(['bad-magic']);
    expect(states().at(-1)).toBe('failed');
  });

  test('aFileThatIsTooShortSaysSo', async () => {
    session(
      host(() => file(kLog).slice(0, -200)),
      'range',
    );
    await settle();
    expect(errors()).toEqual(['truncated']);
  });

  test('anAnswerThatIsTooShortIsAskedForAgainPastTheCache', async () => {
    expectLog(kLongLog);
    const it = host(() => file(kLongLog));
    const whole = it.fetch;
    let cut = 0;
    it.fetch = async (url, init) => {
      const response = await whole(url, init);
      if (init.cache === 'no-store' || it.asked.length === 1) return response;
      ++cut;
      const bytes = new Uint8Array(await response.arrayBuffer());
      return new Response(bytes.slice(0, -100), {status: 206, headers: response.headers});
    };
    session(it, 'range');
    await settle(1000);
    expect([cut > 0, errors(), states().at(-1)]).toEqual([true, [], 'complete']);
  });

  test('noMoreIsAskedForThanTheCreditAllows', async () => {
    const log = {...kLongLog, chunks: 50};
    expectLog(log);
    const bytes = file(log);
    const it = host(() => bytes);
    let payload = 0;
    const transport: HttpTransport = new HttpTransport(
      () => new RangeSource('https://x/f.qtet', assembler, it.fetch),
      assembler,
      {
        connected: () =>
          transport.open({
            mesh: 'm',
            fields: ['p', 'v'],
            have: {chunks: 0, fields: {}},
            credit: 50_000,
          }),
        message: () => undefined,
        down: () => undefined,
        failed: () => undefined,
        frame: (frame) => {
          assembler.take(frame);
          payload += frame.payload.length;
        },
      },
    );
    transport.connect();
    await settle(1000);
    expect(payload).toBeGreaterThan(49_000);
    expect(payload).toBeLessThan(50_000 + 3 * 32 * 1024);
    const before = payload;
    transport.applied(100_000);
    await settle(1000);
    expect(payload).toBeGreaterThan(before);
    transport.disconnect();
  });
});

test('numberedChunksGiveTheSame', async () => {
  const it = host(() => file(kLog));
  it.ranges = false;
  session(it, 'chunks', ['v']);
  await settle(500);
  expect(states().at(-1)).toBe('complete');
  expect(it.asked[0]).toBe('https://x/v1/meshes/m/base');
  expect(it.asked).toContain('https://x/v1/meshes/m/chunks/39');
  expect(it.asked).toContain('https://x/v1/meshes/m/fields/v/chunks/39');
});

test('whatIsHereIsNotAskedForAgainAndLaggingFieldsComeInTheirChunk', () => {
  assembler.take({
    stream: 1,
    chunk: 0,
    firstPart: 0xffff,
    parts: 0,
    payload: fakeHead({...kLog, chunks: 3}),
  });
  const few = new FakeCodec({...kLog, chunks: 3});
  const table = new Assembler(few, kFakeValues);
  table.take({stream: 1, chunk: 0, firstPart: 0xffff, parts: 0, payload: fakeHead(kLog)});
  const pieces = piecesOf(table, {fields: ['v'], have: {chunks: 2, fields: {v: 1}}});
  expect(pieces.map(({chunk, firstPart}) => [chunk, firstPart])).toEqual([
    [1, 3],
    [2, 0],
    [2, 3],
  ]);
});

describe('the choice among transports', () => {
  test('aSocketThatNeverOpensGivesWayToRangesWhichGoOnBehindIt', async () => {
    const it = host(() => file(kLog));
    const sockets: FakeSocket[] = [];
    const kinds: TransportKind[] = [];
    const made = new Session(
      assembler,
      new Publisher(assembler, () => undefined),
      (message) => received.push(message),
      ({url, log}, table, handlers) =>
        new AutoTransport(
          ['websocket', 'range'],
          (kind, its) => {
            kinds.push(kind);
            if (kind === 'range')
              return new HttpTransport(
                () => new RangeSource(log, table, it.fetch),
                table,
                its,
                () => 0,
              );
            return new SocketTransport(
              url,
              its,
              () => {
                sockets.push(new FakeSocket());
                return sockets.at(-1)!;
              },
              () => 0,
            );
          },
          handlers,
        ),
    );
    made.start({
      url: 'ws://x',
      log: 'https://x/f.qtet',
      transport: 'auto',
      mesh: 'm',
      fields: ['p'],
      limit: kFull,
    });
    sockets[0]!.accept();
    sockets[0]!.deliver(
      JSON.stringify({
        type: 'opened',
        stream: 1,
        mesh: 'm',
        digest: 't1',
        bytes: 1000,
        planned: 100,
      }),
    );
    sockets[0]!.deliver(headFrame(1, kLog));
    for (let chunk = 0; chunk < 5; ++chunk) sockets[0]!.deliver(meshFrame(1, chunk));
    for (let lost = 0; lost < 2; ++lost) {
      sockets.at(-1)!.lose(1006);
      await settle(kLongestDelayMs);
    }
    expect(kinds).toEqual(['websocket', 'range']);
    expect(states().at(-1)).toBe('complete');
    expect(codec.chunksApplied).toBe(kLog.chunks);
  });

  test('aFileHasNoSocketAndAForcedWayIsTheOnlyOne', () => {
    expect(kindsOf({url: '', log: 'x', transport: 'auto'})).toEqual(['range']);
    expect(kindsOf({url: 'ws://x', log: 'x', transport: 'chunks'})).toEqual(['chunks']);
    expect(kindsOf({url: 'ws://x', log: '', transport: 'auto'})).toEqual(['websocket']);
    expect(kindsOf({url: 'ws://x', log: 'x', transport: 'auto'})).toEqual([
      'websocket',
      'range',
      'chunks',
    ]);
  });
});
