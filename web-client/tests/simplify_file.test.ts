import {readFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {beforeAll, expect, test as given} from 'vitest';
import type {QtetError} from '../core/protocol/errors';
import {simplifyFile} from '../core/simplify/simplify_file';
import type {PageFile} from '../core/simplify/page_files';

const bytes = readFileSync(join(dirname(process.env.QTET_WASM!), 'qtet-simplify.wasm'));
/** Empty: the build did without. */
const test = given.skipIf(bytes.length === 0);
let module: WebAssembly.Module;
beforeAll(() => {
  if (bytes.length > 0) module = new WebAssembly.Module(bytes);
});

/** Gives fewer bytes than asked for, as a file may. */
function fileOf(name: string, text: string, most = 7): PageFile {
  const content = new TextEncoder().encode(text);
  return {
    name,
    size: content.length,
    read: (at, length) => content.subarray(at, at + Math.min(length, most)),
  };
}

/** A cube of six tetrahedra, in Medit's format. */
const kCube = `MeshVersionFormatted 2
Dimension 3
Vertices 8
0 0 0 0  1 0 0 0  1 1 0 0  0 1 0 0  0 0 1 0  1 0 1 0  1 1 1 0  0 1 1 0
Tetrahedra 6
1 2 3 7 0  1 3 4 7 0  1 4 8 7 0  1 8 5 7 0  1 5 6 7 0  1 6 2 7 0
End
`;

const failure = (files: PageFile[], name: string): QtetError => {
  try {
    simplifyFile(module, files, name, () => undefined);
  } catch (thrown) {
    return thrown as QtetError;
  }
  throw new Error('nothing was wrong');
};

test('a mesh becomes a log, stage by stage', () => {
  const stages = new Set<string>();
  const made = simplifyFile(module, [fileOf('cube.mesh', kCube)], 'cube.mesh', ({stage}) =>
    stages.add(stage),
  );
  expect(made.tetrahedra).toBe(6);
  expect([...made.log.subarray(1, 5)]).toEqual([...new TextEncoder().encode('QTET')]);
  expect([...stages]).toEqual([
    'reading',
    'cleaning',
    'quantising',
    'simplifying',
    'measuring',
    'encoding',
  ]);
});

test('errors have the codes and texts of the tool, and the name of the file', () => {
  const cut = failure([fileOf('cut.mesh', kCube.slice(0, 100))], 'cut.mesh');
  expect(cut.code).toBe('truncated');
  expect(cut.message).toMatch(/^cut\.mesh, line 3: /);
  const missing = failure([], 'none.mesh');
  expect(missing.code).toBe('not-found');
  expect(failure([fileOf('a.exo', 'x')], 'a.exo').message).toMatch(
    /neither in browsers nor in node/,
  );
});

test('a file finds those that it names beside it', () => {
  const node = '4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n';
  const ele = '1 4 0\n1 1 2 3 4\n';
  const files = [fileOf('one.node', node), fileOf('one.ele', ele)];
  const {tetrahedra} = simplifyFile(module, files, 'one.node', () => undefined);
  expect(tetrahedra).toBe(1);
});
