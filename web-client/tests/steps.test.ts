import {expect, test} from 'vitest';
import {wayOf} from '../viewer/page/undo';
import {kMaxSteps, Steps, titleOf} from '../viewer/settings/steps';

const view = (entries: Record<string, string>): Map<string, string> =>
  new Map(Object.entries(entries));

test('undoAndRedoGoThroughTheViewsAndSayWhatChanges', () => {
  const steps = new Steps(view({}));
  steps.take(view({colormap: 'turbo'}));
  steps.take(view({colormap: 'turbo', clip: 'x:0.5'}));
  expect(steps.undo()).toEqual([['clip', null]]);
  expect(steps.undo()).toEqual([['colormap', null]]);
  expect(steps.undo()).toBeNull();
  expect(steps.redo()).toEqual([['colormap', 'turbo']]);
  expect(steps.redo()).toEqual([['clip', 'x:0.5']]);
  expect(steps.redo()).toBeNull();
});

test('aNewStepAfterAnUndoForgetsWhatWasUndone', () => {
  const steps = new Steps(view({}));
  steps.take(view({edges: 'off'}));
  steps.undo();
  steps.take(view({surface: 'off'}));
  expect(steps.redo()).toBeNull();
  expect(steps.undo()).toEqual([['surface', null]]);
});

test('nothingThatDiffersIsNoStepAndNeitherIsTheMesh', () => {
  const steps = new Steps(view({field: 'p'}));
  steps.take(view({field: 'p'}));
  steps.take(view({field: 'p', mesh: 'fin'}));
  expect(steps.undo()).toBeNull();
});

test('aCameraThatIsReadAgainDiffersByRoundingOnly', () => {
  const steps = new Steps(view({camera: '1,2,3,0,0,0'}));
  steps.take(view({camera: '1.00001,2,3,0,0,0'}));
  expect(steps.undo()).toBeNull();
  steps.take(view({camera: '1.001,2,3,0,0,0'}));
  expect(steps.undo()).toEqual([['camera', '1.00001,2,3,0,0,0']]);
  steps.take(view({}));
  expect(steps.undo()).toEqual([['camera', '1.00001,2,3,0,0,0']]);
});

test.each([-1, 0, 1])('theStepsAreBounded (%i)', (more) => {
  const steps = new Steps(view({opacity: '0'}));
  for (let i = 1; i <= kMaxSteps + more; ++i) steps.take(view({opacity: String(i)}));
  let count = 0;
  while (steps.undo()) ++count;
  expect(count).toBe(Math.min(kMaxSteps, kMaxSteps + more));
});

test('aRestartForgetsTheViewsOfAnotherMesh', () => {
  const steps = new Steps(view({}));
  steps.take(view({edges: 'off'}));
  steps.restart(view({edges: 'off'}));
  expect(steps.undo()).toBeNull();
});

test('theStatusLineNamesEachSettingOnce', () => {
  expect(titleOf([['colormap', null]])).toBe('colour map');
  expect(
    titleOf([
      ['clip', 'x'],
      ['clip-mode', 'cells'],
      ['range', '0,1'],
    ]),
  ).toBe('clip, range');
  expect(
    titleOf([
      ['points', null],
      ['length-unit', 'mm'],
    ]),
  ).toBe('kept points, unit of length');
});

test('theKeysAreThoseOfBothSystems', () => {
  const none = {ctrlKey: false, metaKey: false, altKey: false, shiftKey: false};
  expect(wayOf({...none, key: 'z', ctrlKey: true})).toBe('undo');
  expect(wayOf({...none, key: 'z', metaKey: true})).toBe('undo');
  expect(wayOf({...none, key: 'Z', ctrlKey: true, shiftKey: true})).toBe('redo');
  expect(wayOf({...none, key: 'y', ctrlKey: true})).toBe('redo');
  expect(wayOf({...none, key: 'z'})).toBeNull();
  expect(wayOf({...none, key: 'z', ctrlKey: true, altKey: true})).toBeNull();
});
