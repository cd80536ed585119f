// Decides which transports can read a source, and makes them.

import type {LogTable} from '../protocol/log_table';
import {AutoTransport, kTransportKinds, type TransportKind} from './auto_transport';
import {ChunkSource, RangeSource} from './block_source';
import {HttpTransport} from './http_transport';
import {SocketTransport} from './socket_transport';
import {fetchWith, ticketUrl} from './token';
import type {Transport, TransportHandlers} from './transport';

/** Where a log lies, and how it is read. */
export interface LogAddress {
  /** ws: or wss: address of /v1/stream; empty if there is none */
  url: string;
  /**
   * Address of the log as a file, for byte ranges. On a server it is also the base of the chunks
   * (/v1/meshes/{id}/log).
   */
  log: string;
  /** The length of the log's prefix that the first picture takes, where a list says it. */
  firstBytes?: number | undefined;
  /** So many leading chunks are there, of a log that was cut; without it all. */
  chunks?: number | undefined;
  /** `auto`: whatever works. */
  transport: 'auto' | TransportKind;
  /**
   * For servers that guard reading. It is sent with requests, and traded for a ticket before a
   * WebSocket.
   */
  token?: string;
}

/** A qtet-server offers all of them, a file on another host only byte ranges. */
export function kindsOf({url, log, transport}: LogAddress): TransportKind[] {
  if (url === '') return ['range'];
  if (log === '') return ['websocket'];
  return transport === 'auto' ? [...kTransportKinds] : [transport];
}

export function makeTransport(
  source: LogAddress,
  table: LogTable,
  handlers: TransportHandlers,
): Transport {
  const {url, log, firstBytes, token} = source;
  const fetch = fetchWith(token);
  return new AutoTransport(
    kindsOf(source),
    (kind, its) => {
      switch (kind) {
        case 'websocket':
          return new SocketTransport(token ? () => ticketUrl(url, token) : url, its);
        case 'range':
          return new HttpTransport(
            () => new RangeSource(log, table, fetch, firstBytes),
            table,
            its,
          );
        case 'chunks':
          return new HttpTransport(() => new ChunkSource(log, table, fetch), table, its);
      }
    },
    handlers,
  );
}
