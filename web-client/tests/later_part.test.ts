import {afterEach, expect, test, vi} from 'vitest';
import type {QtetError} from '../core/protocol/errors';
import {fetchLaterPart} from '../core/transport/later_part';

const kFile = Uint8Array.from({length: 100}, (_, i) => i);
const kLater = 30;

/** A server whose answers hold these bytes of the file, whatever part is asked for. */
function serve(bytes: Uint8Array, status: number): string[] {
  const asked: string[] = [];
  vi.stubGlobal('fetch', (_: string, init: RequestInit) => {
    asked.push(new Headers(init.headers).get('range')!);
    return Promise.resolve(new Response(bytes.slice(), {status}));
  });
  return asked;
}
const laterPart = (chunks?: number): Promise<Uint8Array> =>
  fetchLaterPart(
    {url: '', log: 'https://x/f.qtet', mesh: 'm', transport: 'auto', chunks},
    kLater,
    kFile.length,
  );

afterEach(() => void vi.unstubAllGlobals());

test('theEndOfTheFileIsAskedForByItsPlaceAndThatOfACutOneByItsLength', async () => {
  const asked = serve(kFile.subarray(-kLater), 206);
  expect(await laterPart()).toEqual(kFile.subarray(-kLater));
  expect(await laterPart(3)).toEqual(kFile.subarray(-kLater));
  expect(asked).toEqual(['bytes=70-99', 'bytes=-30']);
});

test('aServerWithoutRangesSendsAllAndItsEndCounts', async () => {
  for (const length of [kLater, kLater + 1, kFile.length]) {
    serve(kFile.subarray(-length), 200);
    expect(await laterPart()).toEqual(kFile.subarray(-kLater));
  }
});

test('aFileThatEndsTooEarlyIsTruncated', async () => {
  serve(kFile.subarray(0, kLater - 1), 200);
  const thrown = await laterPart().catch((error: unknown) => error as QtetError);
  expect(thrown).toMatchObject({code: 'truncated'});
});
