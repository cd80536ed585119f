import {afterEach, expect, test, vi} from 'vitest';
import {fetchCatalog, isLogFile, isMeshList, meshOfLog, segmentUrl} from '../viewer/page/catalog';

const answer = (meshes: unknown): void => answerText(JSON.stringify({meshes}));
const answerText = (text: string): void => {
  vi.stubGlobal(
    'fetch',
    vi.fn(() => Promise.resolve(new Response(text))),
  );
};
afterEach(() => vi.unstubAllGlobals());

test('aPublishedListHasTheAddressesOfItsFiles', async () => {
  const fields = {fields: ['T', 'p'], series: ['T'], firstField: 'T@0'};
  const entry = {id: 'a b', tetrahedra: 7, ...fields, firstBytes: 9300};
  answer([{...entry, links: {log: 'a%20b.qtet'}}]);
  const list = new URL('https://a.org/meshes/index.json');
  expect(isMeshList(list)).toBe(true);
  expect(await fetchCatalog(list)).toEqual([
    {
      id: 'a b',
      tetrahedra: 7,
      ...fields,
      log: 'https://a.org/meshes/a%20b.qtet',
      firstBytes: 9300,
    },
  ]);
  expect(vi.mocked(fetch).mock.calls[0]![0]).toBe(list.href);
});

test('aServersListHasNoneBecauseItsAddressesAreKnown', async () => {
  answer([{id: 'fin', tetrahedra: 7, fields: [], links: {log: '/v1/meshes/fin/log'}}]);
  const server = new URL('https://a.org/');
  expect(isMeshList(server)).toBe(false);
  expect(await fetchCatalog(server)).toEqual([
    {id: 'fin', tetrahedra: 7, fields: [], series: [], firstField: ''},
  ]);
  expect(vi.mocked(fetch).mock.calls[0]![0]).toBe('https://a.org/v1/meshes');
});

test('aFileInMemoryHasItsNameBehindTheAddress', () => {
  const log = new URL('blob:null/4f5abc87-9397-4bbe#my%20part.qtet');
  expect(isLogFile(log)).toBe(true);
  expect(isMeshList(log)).toBe(false);
  expect(meshOfLog(log)).toBe('my part');
  expect(isMeshList(new URL('blob:null/4f5abc87-9397-4bbe#index.json'))).toBe(true);
  expect(isLogFile(new URL('blob:null/4f5abc87-9397-4bbe'))).toBe(false);
});

const kFlow = new URL('https://a.org/runs/my%20flow.json');

test('aListOfSegmentsIsOneMeshWithLogsBesideIt', async () => {
  answerText('{"qtet": "series", "segments": [{"log": "flow #1.qtet", "times": [0, 1]}]}');
  const [entry] = await fetchCatalog(kFlow);
  expect([entry!.id, entry!.log]).toEqual(['my flow', undefined]);
  expect(segmentUrl(kFlow, entry!.segments!, 0)).toBe('https://a.org/runs/flow%20%231.qtet');
});

test('aPublishedListMayHoldListsOfSegments', async () => {
  const links = {log: 'flow.0.qtet', list: 'flow.json'};
  const segments = [{log: 'flow.0.qtet', times: [0]}];
  answer([
    {id: 'flow', fields: ['T@0'], firstField: 'T@0', firstBytes: 9300, links, segments},
    {id: 'fin', links: {log: 'fin.qtet'}},
  ]);
  const [flow, fin] = await fetchCatalog(new URL('https://a.org/runs/index.json'));
  expect(flow).toMatchObject({id: 'flow', fields: [], segments: {logs: ['flow.0.qtet']}});
  expect(flow!.firstBytes).toBeUndefined();
  expect(fin!.segments).toBeUndefined();
  answer([{id: 'flow', segments: []}]);
  await expect(fetchCatalog(kFlow)).rejects.toThrow('no array of at least one segment');
});

test('aWrongListIsRefusedByItsAddressAndItsPlace', async () => {
  answerText('{"qtet": "series", "segments": [{"log": "/etc/x.qtet", "times": [0]}]}');
  const refusal = fetchCatalog(kFlow);
  await expect(refusal).rejects.toThrow(/my%20flow\.json cannot be opened: segments\[0\]\.log is/);
  await expect(refusal).rejects.toMatchObject({code: 'bad-value'});
  for (const text of ['{"qtet": "series", "segm', '[]', '{"qtet": "other"}']) {
    answerText(text);
    await expect(fetchCatalog(kFlow)).rejects.toThrow('is no list of meshes or segments');
  }
});
