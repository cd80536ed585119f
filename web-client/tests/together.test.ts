import {expect, test} from 'vitest';
import {hindrance, leftOut} from '../viewer/drop/together';

const file = (name: string, text = ''): File => new File([text], name);
const pieces = (count: number): string =>
  Array.from({length: count}, (_, i) => `<Piece Source="flow/flow_${i}.vtu"/>`).join('');

test('meshesBesideTheShownOneAreNamed', () => {
  const [a, b, c] = [file('a.vtu'), file('b.vtu'), file('c.qtet')];
  expect(leftOut(a, [a])).toBe('');
  expect(leftOut(a, [a, b])).toBe('b.vtu is not shown beside a.vtu: drop one mesh at a time.');
  expect(leftOut(a, [c, a, b])).toMatch(/^c\.qtet and b\.vtu are not shown beside a\.vtu/);
  expect(leftOut(c, [c, file('notes.txt')])).toMatch(/^notes\.txt is not shown beside c\.qtet/);
  const many = Array.from({length: 9}, (_, i) => file(`${i}.msh`));
  expect(leftOut(a, [a, ...many])).toMatch(/^0\.msh, 1\.msh, 2\.msh, 3\.msh and 5 more are /);
});

test('filesThatTheShownOneNamesAreNot', () => {
  const main = file('flow.pvtu', pieces(2));
  expect(leftOut(main, [main, file('flow_0.vtu'), file('flow_1.vtu')])).toBe('');
  const input = file('part.inp');
  expect(leftOut(input, [input, file('nodes.inp')])).toBe('');
});

test('whatAFileNamesAndLacksIsNamed', async () => {
  const main = file('flow.pvtu', pieces(2));
  expect(await hindrance(main, [main])).toBe(
    'flow.pvtu needs flow_0.vtu and flow_1.vtu, which it names. Drop all of them together.',
  );
  expect(await hindrance(main, [main, file('flow_1.vtu')])).toMatch(
    /^flow\.pvtu needs flow_0\.vtu,/,
  );
  expect(await hindrance(main, [main, file('flow_0.vtu'), file('flow_1.vtu')])).toBe('');
  const series = file('run.pvd', '<DataSet timestep="0" file="run_0.vtu"/>');
  expect(await hindrance(series, [series])).toMatch(/^run\.pvd needs run_0\.vtu,/);
});

test('aSurfaceIsToldThatItHasNoCells', async () => {
  for (const name of ['part.stl', 'PART.STL', 'part.stl.gz'])
    expect(await hindrance(file(name), [])).toMatch(/ is a surface: it has no cells inside, /);
  expect(await hindrance(file('part.msh'), [])).toBe('');
});

test('blocksThatAreNoVolumesAndCommentsAreNotNeeded', async () => {
  const main = file(
    'case.vtm',
    '<!-- <DataSet file="old.vtu"/> --><DataSet file="a&amp;b.vtu"/><DataSet file="wall.vtp"/>',
  );
  expect(await hindrance(main, [main, file('a&b.vtu')])).toBe('');
});

test('filesOfOneNameInSeveralFoldersAreRefused', async () => {
  const main = file('case.vtm', '<DataSet file="a/in.vtu"/><DataSet file="b/in.vtu"/>');
  const refusal = /^case\.vtm needs several files called in\.vtu, in folders /;
  expect(await hindrance(main, [main, file('in.vtu'), file('in.vtu')])).toMatch(refusal);
  const one = file('case.vtm', '<DataSet file="a/in.vtu"/>');
  expect(await hindrance(one, [one, file('in.vtu'), file('in.vtu')])).toMatch(refusal);
});
