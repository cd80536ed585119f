// The logs of tests/same_bytes.txt that are made without options, in parts too, by the simplifier
// in WebAssembly.
import {execFileSync} from 'node:child_process';
import {createHash} from 'node:crypto';
import {existsSync, mkdtempSync, readFileSync, rmSync, statSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {afterAll, beforeAll, describe, expect, test} from 'vitest';
import {simplifyFile} from '../core/simplify/simplify_file';

const built = dirname(process.env.QTET_WASM!);
const wasm = join(built, 'qtet-simplify.wasm');
/** Writes the meshes. Without it, or without the simplifier, nothing is compared. */
const program = join(built, '../bin/same_bytes');
const lines = readFileSync(new URL('../../tests/same_bytes.txt', import.meta.url), 'utf8');
const kRow = /^([0-9a-f]{64}) {2}((\w+\.vtu)(?: in parts of (\d+) cells)?)$/gm;
const rows = [...lines.matchAll(kRow)].map(([, digest, row, name, cellsOfAPart = 0]) => ({
  digest,
  row,
  name: name!,
  cellsOfAPart: Number(cellsOfAPart),
}));

describe.skipIf(statSync(wasm).size === 0 || !existsSync(program))('the same bytes', () => {
  let folder: string;
  let module: WebAssembly.Module;
  beforeAll(() => {
    folder = mkdtempSync(join(tmpdir(), 'qtet-'));
    execFileSync(program, ['--meshes', folder]);
    module = new WebAssembly.Module(readFileSync(wasm));
  });
  afterAll(() => rmSync(folder, {recursive: true, force: true}));

  test('the table has logs without options', () => {
    expect(rows.length).toBeGreaterThan(5);
    expect(rows.some(({cellsOfAPart}) => cellsOfAPart > 0)).toBe(true);
  });

  test.each(rows)('$row gives the log of the table', {timeout: 60_000}, (given) => {
    const {digest, name, cellsOfAPart} = given;
    const content = readFileSync(join(folder, name));
    const file = {
      name,
      size: content.length,
      read: (at: number, length: number) => content.subarray(at, at + length),
    };
    const {log} = simplifyFile(module, [file], name, () => undefined, cellsOfAPart);
    expect(createHash('sha256').update(log).digest('hex')).toBe(digest);
  });
});
