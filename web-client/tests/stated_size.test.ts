// Sizes that a server or a file states: none makes a page allocate what is not there.

import {afterEach, beforeEach, describe, expect, test, vi} from 'vitest';
import {headBytesOf} from '../core/transport/block_source';
import {RangedFile, type Fetch} from '../core/transport/ranged_file';
import {kMaxAnswerBytes, kMaxFileBytes, kMaxRoomAhead} from '../core/transport/stated_size';
import {fetchCatalog} from '../viewer/page/catalog';

const kBody = new Uint8Array([1, 2, 3]);
const {signal} = new AbortController();

const answering =
  (headers: Record<string, string>, status = 200): Fetch =>
  async () =>
    new Response(kBody, {status, headers});

const read = (fetch: Fetch): Promise<Uint8Array> =>
  new RangedFile('https://x/a.qtet', fetch).read(0, 3, signal);

const tooLarge = {name: 'QtetError', code: 'limit-exceeded'};

describe('a file without ranges', () => {
  const made: number[] = [];
  beforeEach(() => {
    made.length = 0;
    const Bytes = Uint8Array;
    vi.stubGlobal(
      'Uint8Array',
      new Proxy(Bytes, {
        construct(target, words: [number]) {
          if (typeof words[0] === 'number') made.push(words[0]);
          return new target(...words);
        },
      }),
    );
  });
  afterEach(() => void vi.unstubAllGlobals());

  test.each(['3e9', '2e16', '3000000000', '20000000000000000'])(
    'that states %s bytes is refused before anything is allocated',
    async (length) => {
      await expect(read(answering({'content-length': length}))).rejects.toMatchObject(tooLarge);
      expect(Math.max(0, ...made)).toBe(0);
    },
  );

  test.each([String(kMaxAnswerBytes), '1000000000', '3', '-5', 'many', ''])(
    'that states "%s" bytes is read, and takes no room far ahead',
    async (length) => {
      expect([...(await read(answering({'content-length': length})))]).toEqual([...kBody]);
      expect(Math.max(0, ...made)).toBeLessThanOrEqual(kMaxRoomAhead);
    },
  );
});

test('a part that states more than a browser can hold is refused', async () => {
  const fetch = answering({'content-length': String(kMaxAnswerBytes + 1)}, 206);
  await expect(read(fetch)).rejects.toMatchObject(tooLarge);
});

test.each([
  [String(kMaxFileBytes), true],
  ['9007199254740993', false],
  ['99999999999999999999', false],
])('a file of %s bytes has places in a number: %s', async (total, isFine) => {
  const done = read(answering({'content-range': `bytes 0-2/${total}`}, 206));
  if (isFine) expect((await done).length).toBe(3);
  else await expect(done).rejects.toMatchObject(tooLarge);
});

test.each([
  [8 << 20, 256 << 20, true],
  [(8 << 20) + 1, 0, false],
  [0, (256 << 20) + 1, false],
])('a head with a manifest of %i and a table of %i bytes: %s', (manifest, table, isFine) => {
  const header = new Uint8Array(64);
  const view = new DataView(header.buffer);
  view.setUint32(24, manifest, true);
  view.setUint32(28, table, true);
  if (isFine) expect(headBytesOf(header)).toBe(64 + manifest + table);
  else expect(() => headBytesOf(header)).toThrow('more than a log can have');
});

describe('a list of meshes', () => {
  afterEach(() => void vi.unstubAllGlobals());
  const listed = (members: string): Promise<unknown> => {
    const text = `{"meshes": [{"id": "m", "links": {"log": "m.qtet"}, ${members}}]}`;
    vi.stubGlobal('fetch', async () => new Response(text));
    return fetchCatalog(new URL('https://x/index.json'));
  };

  test.each(['"tetrahedra": 1e300', '"chunks": -1', '"firstBytes": 0.5', '"chunks": "9"'])(
    'with %s is refused',
    async (members) => {
      await expect(listed(members)).rejects.toMatchObject({code: 'bad-message'});
    },
  );

  test('with counts is taken', async () => {
    const list = await listed('"tetrahedra": 7, "chunks": 0, "firstBytes": 64');
    expect(list).toMatchObject([{tetrahedra: 7, chunks: 0, firstBytes: 64}]);
  });
});
