// Logs of regions: packets in any legal order, coarse cells beside fine ones, and the packets that
// come first. Uses the golden log and the built codec.

import {readFileSync} from 'node:fs';
import {describe, expect, test, vi} from 'vitest';
import type {Packet} from '../core/protocol/packet';
import {kFirstFieldPart, kHeadPart, kStructurePart} from '../core/protocol/parts';
import {Assembler} from '../core/decode/assembler';
import {ChunkSource} from '../core/transport/block_source';
import {WasmCodec} from '../core/decode/codec';
import {kDraco} from '../core/decode/draco';
import {HttpTransport, piecesOf} from '../core/transport/http_transport';
import {surfaceBoxesOf} from '../core/protocol/surface_boxes';
import type {OpenRequest} from '../core/protocol/messages';
import {
  inOrder,
  kNoViewRequest,
  urgency,
  wireView,
  type ViewRequest,
} from '../core/protocol/view_request';
import {kTestWasm} from './whole_log';

const kLog = new URL('../../tests/golden/valid/regions.qtet', import.meta.url);
/** A machine under load may stall for seconds. */
const kPatience = {timeout: 60000};
const kDigests = new URL('../../tests/golden/digests.txt', import.meta.url);

async function opened(): Promise<{assembler: Assembler; bytes: Uint8Array}> {
  const bytes = new Uint8Array(readFileSync(kLog));
  const assembler = new Assembler(
    new WasmCodec(await WebAssembly.compile(readFileSync(kTestWasm))),
    kDraco,
  );
  const header = new DataView(bytes.buffer, bytes.byteOffset);
  assembler.take({
    stream: 1,
    chunk: 0,
    firstPart: kHeadPart,
    parts: 0,
    payload: bytes.subarray(0, 64 + header.getUint32(24, true) + header.getUint32(28, true)),
  });
  return {assembler, bytes};
}

function takeChunk(assembler: Assembler, bytes: Uint8Array, chunk: number): void {
  const parts = kFirstFieldPart + assembler.manifest!.fields.length;
  const start = assembler.blockOffset(chunk, 0);
  const end = assembler.blockOffset(chunk, parts - 1) + assembler.blockSize(chunk, parts - 1);
  assembler.take({
    stream: 1,
    chunk,
    firstPart: kStructurePart,
    parts,
    payload: bytes.slice(start, end),
  });
}

/**
 * Six times the cells' volume, six times the volume within the boundary, and whether each boundary
 * edge has exactly one opposite. If nothing cracks, the volumes are equal and the boundary is
 * closed.
 */
function measure({codec}: Assembler): {cells: number; enclosed: number; closed: boolean} {
  const points = codec.points();
  const at = (vertex: number): number[] => [...points.subarray(3 * vertex, 3 * vertex + 3)];
  const det = (a: number[], b: number[], c: number[]): number =>
    a[0]! * (b[1]! * c[2]! - b[2]! * c[1]!) -
    a[1]! * (b[0]! * c[2]! - b[2]! * c[0]!) +
    a[2]! * (b[0]! * c[1]! - b[1]! * c[0]!);
  let cells = 0;
  const tetrahedra = codec.tetrahedra();
  for (let i = 0; i < tetrahedra.length; i += 4) {
    const [a, b, c, d] = [...tetrahedra.subarray(i, i + 4)].map(at) as [
      number[],
      number[],
      number[],
      number[],
    ];
    const from = (p: number[]): number[] => p.map((x, axis) => x - a[axis]!);
    cells += det(from(b), from(c), from(d));
  }
  let enclosed = 0;
  const edges = new Map<string, number>();
  const boundary = codec.boundary();
  for (let i = 0; i < boundary.length; i += 3) {
    const [a, b, c] = boundary.subarray(i, i + 3) as unknown as [number, number, number];
    if (a === b) continue; // a hole
    enclosed += det(at(a), at(b), at(c));
    for (const [p, q] of [
      [a, b],
      [b, c],
      [c, a],
    ] as const) {
      const key = p < q ? `${p} ${q}` : `${q} ${p}`;
      edges.set(key, (edges.get(key) ?? 0) + (p < q ? 1 : -1));
    }
  }
  return {cells, enclosed, closed: edges.size > 0 && [...edges.values()].every((sum) => sum === 0)};
}

/** A generator that gives the same numbers each time. */
function randomOf(seed: number): () => number {
  return () => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

describe.skipIf(kTestWasm === '')('regions', () => {
  test('packetsInAnyOrderGiveTheSameMeshWithoutCracksOnTheWay', async () => {
    const digest = readFileSync(kDigests, 'utf8')
      .split('\n')
      .find((line) => line.endsWith('regions.qtet'))!
      .split(/\s+/)[0];
    let unlike = 0;
    for (let seed = 1; seed <= 5; ++seed) {
      const {assembler, bytes} = await opened();
      const fields = assembler.manifest!.fields.map((_, field) => field);
      expect(assembler.packets.length).toBeGreaterThan(2);
      const random = randomOf(seed);
      const chunks = Array.from({length: assembler.chunkCount}, (_, chunk) => chunk).sort(
        () => random() - 0.5,
      );
      for (const chunk of chunks) {
        takeChunk(assembler, bytes, chunk);
        let applied = false;
        while (assembler.step(fields, true)) applied = true;
        if (!applied || assembler.codec.chunksApplied === 0) continue;
        const {cells, enclosed, closed} = measure(assembler);
        expect(Math.abs(cells)).toBeGreaterThan(0);
        expect(Math.abs(enclosed)).toBe(Math.abs(cells));
        expect(closed).toBe(true);
        if (assembler.codec.tetrahedronCount > assembler.statistics(fields).tetrahedra) ++unlike;
      }
      expect(assembler.codec.digest()).toBe(digest);
      const {tetrahedra, total, bytes: here, bytesNeeded} = assembler.statistics(fields);
      expect([tetrahedra, here]).toEqual([total.tetrahedra, bytesNeeded]);
    }
    expect(unlike).toBeGreaterThan(0); // there were holes, and they were not counted
  });

  test('thePlanTellsOfEachChunkOfTheHeadAndOfEachBandWithItsLevel', async () => {
    const {assembler, bytes} = await opened();
    const {codec, packets} = assembler;
    const fields = assembler.manifest!.fields.map((_, field) => field);
    const plan = assembler.plan(fields);
    const seen = Array.from({length: assembler.chunkCount}, (_, chunk) => {
      takeChunk(assembler, bytes, chunk);
      while (assembler.step(fields, true)) continue;
      const {bytes: here, level} = assembler.statistics(fields);
      return {bytes: here, level};
    });
    const depthOf = (chunk: number): number => packets[chunk - codec.headChunks]?.depth ?? -1;
    expect(depthOf(codec.chunkCount - 1)).toBeGreaterThan(0);
    expect(plan).toEqual(
      seen.filter((_, chunk) => chunk < codec.headChunks || depthOf(chunk) !== depthOf(chunk + 1)),
    );
    expect(plan.at(-1)!.level).toBe(assembler.manifest!.levels.at(-1)!.level);
  });

  test('whatIsLookedAtComesFirstAndOnlyWhatIsMissing', async () => {
    const {assembler, bytes} = await opened();
    const size = assembler.lattice!.size;
    const view: ViewRequest = {...kNoViewRequest, planes: [{normal: [1, 0, 0], offset: 200}]};
    const request: OpenRequest = {
      mesh: 'm',
      fields: [],
      have: {chunks: 0, fields: {}},
      credit: 1e9,
      view,
    };
    const order = piecesOf(assembler, request).map(({chunk}) => chunk);
    expect([...order].sort((a, b) => a - b)).toEqual(
      Array.from({length: assembler.chunkCount}, (_, chunk) => chunk),
    );
    const urgent = assembler.packets.filter(({box}) => urgency(view, box, size) === 0).length;
    expect(urgent).toBeGreaterThan(0);
    expect(urgent).toBeLessThan(assembler.packets.length);
    // In that order no chunk waits for a later one.
    const heads = assembler.chunkCount - assembler.packets.length;
    for (const chunk of order.slice(0, heads + urgent)) {
      takeChunk(assembler, bytes, chunk);
      expect(assembler.step([], true)).toBe(true);
    }
    const beyond = assembler.rangesBeyond(assembler.receivedChunks, kStructurePart);
    const have = {chunks: assembler.receivedChunks, ranges: beyond, fields: {}};
    expect(piecesOf(assembler, {...request, have}).map(({chunk}) => chunk)).toEqual(
      order.slice(heads + urgent),
    );
  });

  test(
    'anotherViewChangesWhatComesNext',
    async () => {
      const {assembler, bytes} = await opened();
      const asked: number[] = [];
      const size = assembler.lattice!.size;
      const far: ViewRequest = {...kNoViewRequest, planes: [{normal: [1, 0, 0], offset: 200}]};
      const transport: HttpTransport = new HttpTransport(
        () =>
          new ChunkSource('https://x/v1/meshes/m/log', assembler, async (url) => {
            const chunk = Number(/chunks\/(\d+)$/.exec(url)?.[1] ?? -1);
            if (chunk < 0) return new Response(bytes.slice(0, assembler.blockOffset(0, 2)));
            return new Response(
              bytes.slice(
                assembler.blockOffset(chunk, 0),
                assembler.blockOffset(chunk, 1) + assembler.blockSize(chunk, 1),
              ),
            );
          }),
        assembler,
        {
          connected: () =>
            transport.open({
              mesh: 'm',
              fields: [],
              have: {chunks: 0, fields: {}},
              credit: assembler.blockSize(0, 0) + 1,
            }),
          message: () => undefined,
          down: () => undefined,
          failed: (error) => {
            throw error;
          },
          frame: ({chunk}) => asked.push(chunk),
        },
      );
      transport.connect();
      await vi.waitFor(() => expect(asked.length).toBeGreaterThan(0), kPatience);
      const before = asked.length;
      transport.look(far);
      transport.applied(1e9);
      await vi.waitFor(() => expect(asked.length).toBe(assembler.chunkCount), kPatience);
      transport.disconnect();
      const after = asked.slice(before).filter((chunk) => assembler.codec.headChunks <= chunk);
      const expected = inOrder(assembler.packets, far, size)
        .map(({chunk}) => chunk)
        .filter((chunk) => after.includes(chunk));
      expect(after).toEqual(expected);
      expect(after).not.toEqual([...after].sort((a, b) => a - b));
    },
    kPatience.timeout,
  );
});

test('boxesInSightComeBeforeBoxesBehindAndParentsBeforeChildren', () => {
  const packets: Packet[] = [
    {chunk: 1, depth: 0, box: [0, 0, 0, 255, 255, 255]},
    {chunk: 2, depth: 1, box: [0, 0, 0, 127, 255, 255]},
    {chunk: 3, depth: 1, box: [128, 0, 0, 255, 255, 255]},
  ];
  const right: ViewRequest = {frustum: [{normal: [1, 0, 0], offset: 700}], planes: [], point: null};
  expect(inOrder(packets, right, 1024).map(({chunk}) => chunk)).toEqual([1, 3, 2]);
  expect(
    inOrder(packets, {...kNoViewRequest, point: [900, 0, 0]}, 1024).map(({chunk}) => chunk),
  ).toEqual([1, 3, 2]);
  expect(inOrder(packets, kNoViewRequest, 1024).map(({chunk}) => chunk)).toEqual([1, 2, 3]);
});

test('aViewRequestTravelsInTheMeshsOwnUnits', () => {
  const view = wireView(
    {
      frustum: [{normal: [0, 0, 1], offset: 10}],
      planes: [{normal: [1, 0, 0], offset: 4}],
      point: [2, 0, 0],
    },
    {origin: [100, 0, 0], step: 0.5, size: 256},
  );
  expect(view).toEqual({frustum: [[0, 0, 1, -5]], planes: [[1, 0, 0, -102]], point: [101, 0, 0]});
  expect(wireView(kNoViewRequest, {origin: [0, 0, 0], step: 1, size: 256})).toBeNull();
  const surfaceBoxes = surfaceBoxesOf(Float32Array.of(8, 8, 8), 256);
  expect(
    wireView({...kNoViewRequest, surfaceBoxes}, {origin: [0, 0, 0], step: 1, size: 256}),
  ).toEqual({
    box: [0, 0, 0, 32, 32, 32],
  });
  // A box beside it would ask for more.
  expect(
    wireView(
      {...kNoViewRequest, surfaceBoxes, isovalue: {field: 'p', values: [2]}},
      {origin: [0, 0, 0], step: 1, size: 256},
    ),
  ).toEqual({isovalue: {field: 'p', values: [2]}});
});
