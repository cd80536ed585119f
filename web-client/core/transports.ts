// Decides which transports can read a source, and makes them.

import {AutoTransport, kTransportKinds, type TransportKind} from './auto_transport';
import {ChunkSource, RangeSource} from './block_source';
import {HttpTransport} from './http_transport';
import {SocketTransport} from './socket_transport';
import {fetchWith, ticketUrl} from './token';
import type {LogTable, Transport, TransportHandlers} from './transport';
import type {Source} from './worker_messages';

/** A qtet-server offers all of them, a file on another host only byte ranges. */
export function kindsOf({
  url,
  log,
  transport,
}: Pick<Source, 'url' | 'log' | 'transport'>): TransportKind[] {
  if (url === '') return ['range'];
  if (log === '') return ['websocket'];
  return transport === 'auto' ? [...kTransportKinds] : [transport];
}

export function makeTransport(
  source: Source,
  table: LogTable,
  handlers: TransportHandlers,
): Transport {
  const {url, log, token} = source;
  const fetch = fetchWith(token);
  return new AutoTransport(
    kindsOf(source),
    (kind, its) => {
      switch (kind) {
        case 'websocket':
          return new SocketTransport(
            token ? () => ticketUrl(url, token) : url,
            its,
            undefined,
            undefined,
            table,
          );
        case 'range':
          return new HttpTransport(() => new RangeSource(log, table, fetch), table, its);
        case 'chunks':
          return new HttpTransport(() => new ChunkSource(log, table, fetch), table, its);
      }
    },
    handlers,
  );
}
