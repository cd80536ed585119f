import {expect, test, vi} from 'vitest';
import {mainFile} from '../core/simplify/simplify_files';

vi.mock('qtet-simplify.wasm?url', () => ({default: 'simplify.wasm'}));

const mainOf = (...names: string[]): string =>
  mainFile(names.map((name) => new File([], name))).name;

test('amongDroppedFilesTheOneThatNamesTheOthersIsRead', () => {
  const naming = ['a.pvd', 'b.VTM', 'c.pvtu', 'd.node'];
  for (const [i, first] of naming.entries())
    for (const second of [...naming.slice(i + 1), 'e.vtu']) {
      expect(mainOf(first, second)).toBe(first);
      expect(mainOf(second, first)).toBe(first);
    }
});

test('amongFilesThatNameNoneTheFirstIsRead', () => {
  expect(mainOf('b.vtu', 'a.vtu')).toBe('b.vtu');
});
