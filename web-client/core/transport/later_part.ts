// Brings a log's part of later instants (codec/FORMAT.md, "Later instants"), which no stream has.

import {QtetError} from '../protocol/errors';
import {fetchChecked} from './ranged_file';
import {fetchWith} from './token';
import type {LogAddress} from './transports';

/** Of a server that is known by its stream alone. */
function fileOf(stream: string, mesh: string): string {
  const url = new URL(`meshes/${encodeURIComponent(mesh)}/log`, stream);
  url.protocol = url.protocol.replace('ws', 'http');
  return url.href;
}

/**
 * The last `bytes` bytes of the log, also of one that was cut. Throws `network`, `not-found`,
 * `http`, `truncated`.
 */
export async function fetchLaterPart(
  {url, log, mesh, token}: Pick<LogAddress, 'url' | 'log' | 'token'> & {mesh: string},
  bytes: number,
): Promise<Uint8Array> {
  const fetch = fetchWith(token) ?? ((address, init) => globalThis.fetch(address, init));
  const address = log || fileOf(url, mesh);
  const response = await fetchChecked(fetch, address, {headers: {Range: `bytes=-${bytes}`}});
  // a server without ranges sends all
  const part = new Uint8Array(await response.arrayBuffer()).slice(-bytes);
  if (part.length < bytes)
    throw new QtetError('truncated', `${address} ends too early. Copy the file again.`);
  return part;
}
