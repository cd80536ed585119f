// The meshes of a server, GET /v1/meshes of proto/PROTOCOL.md, or of a folder that `qtet publish`
// made. The latter has the same list in its index.json, with addresses of files. A list of segments
// is one mesh.

import {errorCode, errorText, QtetError} from '../../core/protocol/errors';
import {isSegmentList, readSegmentList, type SegmentList} from '../../core/protocol/segment_list';
import {statedBytes} from '../../core/transport/stated_size';
import {refusedOrigin} from '../../core/transport/refused_origin';
import {fetchWith} from '../../core/transport/token';

export interface MeshEntry {
  id: string;
  tetrahedra: number;
  /** Keys; a server's list names a series once, and perhaps not all of many fields. */
  fields: string[];
  /** Those of `fields` that are series. */
  series: string[];
  /** The key of the field to show first; empty if it is unknown or there is none. */
  firstField: string;
  /** The address of the log as a file, from a published list; without it the server has it. */
  log?: string;
  /** The length of its prefix that the first picture takes, from a published list. */
  firstBytes?: number;
  /** So many of its chunks are there, from the list of a page that holds a cut log. */
  chunks?: number;
  /** The mesh is a list of segments. */
  segments?: SegmentList;
}

/** Throws a QtetError whose text says what to do. `token` is empty if the server asks for none. */
export async function fetchCatalog(base: URL, token = ''): Promise<MeshEntry[]> {
  const isList = isMeshList(base);
  const url = isList ? base : new URL('v1/meshes', base);
  let response: Response;
  try {
    response = await (fetchWith(token) ?? fetch)(url.href, {});
  } catch {
    const refused = await refusedOrigin(url.href);
    if (refused) throw refused;
    throw new QtetError(
      'offline',
      `The server at ${base.host} does not answer. Check the connection and try again.`,
    );
  }
  if (!response.ok)
    throw new QtetError(
      'http',
      `The server at ${base.host} answers "${response.status} ${response.statusText}" instead ` +
        'of its meshes. For a .qtet file on a plain web server, give its address: ?src=FILE.qtet',
    );
  statedBytes(response, url.href);
  const bytes = await response.arrayBuffer();
  const body = parsed(bytes) as {meshes?: unknown} | null;
  if (isList && isSegmentList(body)) return [entryOfSegments(url, body, bytes.byteLength)];
  if (!Array.isArray(body?.meshes))
    throw new QtetError(
      'bad-message',
      `${url.href} is no list of ${isList ? 'meshes or segments' : 'meshes'}. ` +
        'Is this a qtet server? For a .qtet file on another one, give its address: ?src=FILE.qtet',
    );
  return (body.meshes as Listed[]).map((mesh) => {
    if (isList && mesh.segments !== undefined)
      return {...entryOfSegments(url, mesh, bytes.byteLength), id: String(mesh.id)};
    return entryOf(mesh, isList ? url : null);
  });
}

/** `list`: the address of a published list, whose members count. */
function entryOf(mesh: Listed, list: URL | null): MeshEntry {
  const [firstBytes, chunks] = [countIn(mesh, 'firstBytes'), countIn(mesh, 'chunks')];
  return {
    id: String(mesh.id),
    tetrahedra: countIn(mesh, 'tetrahedra') ?? 0,
    fields: strings(mesh.fields),
    series: strings(mesh.series),
    firstField: typeof mesh.firstField === 'string' ? mesh.firstField : '',
    ...(list && {log: new URL(String(mesh.links?.log), list).href}),
    ...(list && firstBytes !== undefined && {firstBytes}),
    ...(list && chunks !== undefined && {chunks}),
  };
}

/** A number from 0 to 2^53 - 1; undefined: there is none. Throws `bad-message`. */
function countIn(mesh: Listed, key: 'tetrahedra' | 'firstBytes' | 'chunks'): number | undefined {
  const value = mesh[key] ?? undefined;
  if (value === undefined || (Number.isSafeInteger(value) && Number(value) >= 0))
    return value as number | undefined;
  throw new QtetError(
    'bad-message',
    `The list of meshes says that "${key}" of ${String(mesh.id)} is ${JSON.stringify(value)}, ` +
      'which is no count. Write the list again.',
  );
}

function strings(listed: unknown): string[] {
  return Array.isArray(listed) ? listed.map(String) : [];
}

/** Null if it is no JSON. */
function parsed(bytes: ArrayBuffer): unknown {
  try {
    return JSON.parse(new TextDecoder().decode(bytes));
  } catch {
    return null;
  }
}

/** Throws a QtetError that names the list. */
function entryOfSegments(url: URL, body: unknown, sizeBytes: number): MeshEntry {
  try {
    const segments = readSegmentList(body, sizeBytes);
    return {id: meshOfLog(url), tetrahedra: 0, fields: [], series: [], firstField: '', segments};
  } catch (thrown) {
    throw new QtetError(
      errorCode(thrown),
      `The list of segments ${url.href} cannot be opened: ${errorText(thrown)}`,
    );
  }
}

/** An entry as it arrives: no member has been checked. */
type Listed = Partial<Record<keyof MeshEntry, unknown>> & {links?: {log?: unknown}};

/** The path; of something in memory (blob:) the name behind the #. */
function nameIn({protocol, pathname, hash}: URL): string {
  return protocol === 'blob:' ? hash : pathname;
}

/** Whether the address names a list: of meshes, as `qtet publish` makes it, or of segments. */
export function isMeshList(base: URL): boolean {
  return nameIn(base).endsWith('.json');
}

/** Whether the address names a log on any web server. */
export function isLogFile(base: URL): boolean {
  return nameIn(base).endsWith('.qtet');
}

/** The name of a log or of a list of segments, as a mesh's id. */
export function meshOfLog(base: URL): string {
  return decodeURIComponent(
    nameIn(base)
      .replace(/^.*[/#]/, '')
      .replace(/\.(qtet|json)$/, ''),
  );
}

/** The address of a segment's log. */
export function segmentUrl(base: URL, {logs}: SegmentList, segment: number): string {
  return new URL(encodeURIComponent(logs[segment]!), base).href;
}

/** The address of a server's log as a file. */
export function logUrl(base: URL, mesh: string): string {
  return new URL(`v1/meshes/${encodeURIComponent(mesh)}/log`, base).href;
}

/** The address of the stream that belongs to an HTTP address. */
export function streamUrl(base: URL): string {
  const url = new URL('v1/stream', base);
  url.protocol = base.protocol === 'https:' ? 'wss:' : 'ws:';
  return url.href;
}
