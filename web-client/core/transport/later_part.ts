// Brings a log's part of later instants (codec/FORMAT.md, "Later instants"), which no stream has.

import {QtetError} from '../protocol/errors';
import {fetchChecked} from './ranged_file';
import {fetchWith} from './token';
import type {LogAddress} from './transports';

/** The log's address on a server that is known by its stream alone. */
function fileOf(stream: string, mesh: string): string {
  const url = new URL(`meshes/${encodeURIComponent(mesh)}/log`, stream);
  url.protocol = url.protocol.replace('ws', 'http');
  return url.href;
}

/**
 * The last `bytes` bytes of the log, whose head says that it has `fileBytes`. A log that was cut
 * ends with them, too. Throws `network`, `not-found`, `http`, `truncated`.
 */
export async function fetchLaterPart(
  {url, log, mesh, token, chunks}: LogAddress & {mesh: string},
  bytes: number,
  fileBytes: number,
): Promise<Uint8Array> {
  const fetch = fetchWith(token) ?? ((address, init) => globalThis.fetch(address, init));
  const address = log || fileOf(url, mesh);
  // a range from the end would need a preflight, which many hosts refuse; only pages have cut logs
  const Range =
    chunks === undefined ? `bytes=${fileBytes - bytes}-${fileBytes - 1}` : `bytes=-${bytes}`;
  const response = await fetchChecked(fetch, address, {headers: {Range}});
  // a server without ranges sends all
  const part = new Uint8Array(await response.arrayBuffer()).slice(-bytes);
  if (part.length < bytes)
    throw new QtetError('truncated', `${address} ends too early. Copy the file again.`);
  return part;
}
