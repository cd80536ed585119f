import {afterEach, beforeEach, expect, test, vi} from 'vitest';
import {reconnectDelayMs} from '../core/transport/backoff';
import {SocketTransport} from '../core/transport/socket_transport';
import {fetchWith, ticketUrl} from '../core/transport/token';
import type {Fetch} from '../core/transport/ranged_file';
import {FakeSocket, until} from './fakes';

const kStream = 'wss://x/v1/stream';
let asked: {url: string; method: string; authorization: string | null; range: string | null}[];

/** Notes the requests and answers with these, one after the other. */
function fake(...answers: (Response | Error)[]): Fetch {
  return (url, init) => {
    const headers = new Headers(init.headers);
    asked.push({
      url,
      method: init.method ?? 'GET',
      authorization: headers.get('authorization'),
      range: headers.get('range'),
    });
    const answer = answers.shift() ?? new Error('nothing more was expected');
    return answer instanceof Error ? Promise.reject(answer) : Promise.resolve(answer);
  };
}
const ticket = (name: string): Response =>
  new Response(JSON.stringify({ticket: name, seconds: 30}), {status: 201});

beforeEach(() => {
  asked = [];
});
afterEach(() => void vi.useRealTimers());

test('aTokenGoesWithEveryRequestBesideWhatItHasAlready', async () => {
  await fetchWith('secret', fake(new Response()))!('https://x/log', {
    headers: {Range: 'bytes=0-1'},
  });
  expect(asked).toEqual([
    {url: 'https://x/log', method: 'GET', authorization: 'Bearer secret', range: 'bytes=0-1'},
  ]);
  expect(fetchWith(undefined)).toBeUndefined();
});

test('aStreamsAddressCarriesATicketAndNeverTheToken', async () => {
  expect(await ticketUrl(kStream, 'secret', fake(ticket('t1')))).toBe(
    'wss://x/v1/stream?ticket=t1',
  );
  expect(asked).toEqual([
    {url: 'https://x/v1/tickets', method: 'POST', authorization: 'Bearer secret', range: null},
  ]);
});

test('aServerWithoutTokensNeedsNoTicketAndARefusalIsFinal', async () => {
  expect(await ticketUrl(kStream, 'secret', fake(new Response('', {status: 405})))).toBe(kStream);
  await expect(
    ticketUrl(kStream, 'secret', fake(new Response('', {status: 401}))),
  ).rejects.toMatchObject({code: 'http'});
  await expect(
    ticketUrl(kStream, 'secret', fake(new Response('{}', {status: 201}))),
  ).rejects.toMatchObject({code: 'http'});
  await expect(ticketUrl(kStream, 'secret', fake(new Error('offline')))).rejects.toMatchObject({
    code: 'network',
  });
});

function transportOver(fetch: Fetch): {
  urls: string[];
  sockets: FakeSocket[];
  received: string[];
  transport: SocketTransport;
} {
  const urls: string[] = [],
    sockets: FakeSocket[] = [],
    received: string[] = [];
  const transport = new SocketTransport(
    () => ticketUrl(kStream, 'secret', fetch),
    {
      connected: () => received.push('connected'),
      message: () => undefined,
      frame: () => undefined,
      down: (attempt) => received.push(`down ${attempt}`),
      failed: ({code}) => received.push(`failed ${code}`),
    },
    (url) => {
      urls.push(url);
      sockets.push(new FakeSocket());
      return sockets.at(-1)!;
    },
    () => 0.5,
  );
  return {urls, sockets, received, transport};
}

test('everyConnectionHasATicketOfItsOwn', async () => {
  vi.useFakeTimers();
  const {urls, sockets, received, transport} = transportOver(
    fake(ticket('t1'), new Error('offline'), ticket('t2')),
  );
  transport.connect();
  await until(() => urls.length === 1);
  sockets[0]!.accept();
  sockets[0]!.lose(1006);
  await vi.advanceTimersByTimeAsync(reconnectDelayMs(0, 0.5));
  expect(received).toEqual(['connected', 'down 1', 'down 2']);
  await vi.advanceTimersByTimeAsync(reconnectDelayMs(1, 0.5));
  expect(urls).toEqual([`${kStream}?ticket=t1`, `${kStream}?ticket=t2`]);
});

test('aTicketThatIsRefusedEndsItAndOneThatComesTooLateIsNotUsed', async () => {
  const refused = transportOver(fake(new Response('', {status: 401})));
  refused.transport.connect();
  await until(() => refused.received.length > 0);
  expect(refused.received).toEqual(['failed http']);
  const late = transportOver(fake(ticket('t1')));
  late.transport.connect();
  late.transport.disconnect();
  const used = transportOver(fake(ticket('t2')));
  used.transport.connect(); // its ticket comes behind the other one's
  await until(() => used.urls.length > 0);
  expect(late.urls).toEqual([]);
});
