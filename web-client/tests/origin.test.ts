import {describe, expect, test} from 'vitest';
import {cutOf, fileNameOf, textOf} from '../viewer/panels/origin';

const kOrigin = {mesh: 'fin', field: 'Velocity, x', time: '0.25 s', place: 'clip x:0.5'};

describe('the name of a saved file', () => {
  test('saysMeshFieldTimeAndPlace', () => {
    expect(fileNameOf(kOrigin, 'png')).toBe('fin_Velocity-x_t-0.25-s_clip-x-0.5.png');
    expect(textOf(kOrigin)).toBe('fin, Velocity, x, t = 0.25 s, clip x:0.5');
  });

  test('leavesOutWhatThereIsNot', () => {
    const bare = {mesh: 'fin', field: '', time: '', place: ''};
    expect(fileNameOf(bare, 'png')).toBe('fin.png');
    expect(textOf(bare)).toBe('fin');
    expect(fileNameOf({...bare, mesh: ''}, 'csv')).toBe('mesh.csv');
  });

  test('isAFileNameWhateverTheMeshIsCalled', () => {
    expect(fileNameOf({...kOrigin, mesh: '../a\\b:*?"<>|\n'}, 'csv')).toMatch(/^a-b_Velocity/);
    expect(fileNameOf({...kOrigin, mesh: 'Größe 流'}, 'csv')).toMatch(/^Größe-流_/);
    expect(fileNameOf({...kOrigin, mesh: 'x'.repeat(500)}, 'csv').length).toBeLessThan(255);
    expect(fileNameOf({...kOrigin, place: 'at 1, \u22122'}, 'csv')).toMatch(/_at-1--2\.csv$/);
  });
});

test('theCutIsThatOfThePicture', () => {
  const of = (its: Record<string, string>, firstCut: number | null = null): string =>
    cutOf((name) => its[name] ?? null, {firstCut});
  expect(of({})).toBe('');
  expect(of({}, 2)).toBe('clip z:0.5');
  expect(of({clip: 'none'}, 2)).toBe('');
  expect(of({clip: 'x:0.5 -y:0.3', 'clip-mode': 'slice'})).toBe('slice x:0.5 -y:0.3');
});
