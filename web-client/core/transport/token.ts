// A bearer token: sent over HTTP, and traded for a ticket before a WebSocket, because browsers send
// no headers with one (proto/PROTOCOL.md, "Tokens").

import {QtetError} from '../protocol/errors';
import {fetchChecked, type Fetch} from './ranged_file';

const kPlainFetch: Fetch = (url, init) => globalThis.fetch(url, init);
/** Answers of a server without tokens. Its streams need no ticket. */
const kNoTickets = [404, 405];

/** A fetch that sends the token; `undefined`, the plain fetch, without a token. */
export function fetchWith(
  token: string | undefined,
  fetch: Fetch = kPlainFetch,
): Fetch | undefined {
  if (!token) return undefined;
  return (url, init) => {
    const headers = new Headers(init.headers);
    headers.set('Authorization', `Bearer ${token}`);
    return fetch(url, {...init, headers});
  };
}

/**
 * The stream's address with a fresh ticket, which is good for one connection. Throws `network`,
 * which may pass, or `http`.
 */
export async function ticketUrl(
  stream: string,
  token: string,
  fetch: Fetch = kPlainFetch,
): Promise<string> {
  const tickets = new URL('tickets', stream);
  tickets.protocol = tickets.protocol.replace('ws', 'http');
  let status = 0;
  const noticing: Fetch = async (url, init) => {
    const response = await fetch(url, init);
    ({status} = response);
    return response;
  };
  try {
    const response = await fetchChecked(fetchWith(token, noticing)!, tickets.href, {
      method: 'POST',
    });
    const {ticket} = (await response.json()) as {ticket?: unknown};
    if (typeof ticket !== 'string') throw new QtetError('http', `${tickets.href} gives no ticket.`);
    const address = new URL(stream);
    address.searchParams.set('ticket', ticket);
    return address.href;
  } catch (thrown) {
    if (kNoTickets.includes(status)) return stream;
    throw thrown;
  }
}
