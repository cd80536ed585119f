import {expect, test} from 'vitest';
import {keepFolds, readFolds, type Shelf} from '../viewer/page/folds';

function shelfOf(text: string | null): Shelf & {text: string | null} {
  const shelf = {
    text,
    getItem: () => shelf.text,
    setItem: (_name: string, value: string) => void (shelf.text = value),
  };
  return shelf;
}

test('whatIsKeptIsReadAgain', () => {
  const shelf = shelfOf(null);
  keepFolds(() => shelf, new Map([['view', true]]));
  keepFolds(() => shelf, readFolds(() => shelf).set('colours', false));
  expect([...readFolds(() => shelf)]).toEqual([
    ['view', true],
    ['colours', false],
  ]);
});

test.each([null, '', '{', 'null', '3', '[]', '{"view":"yes"}'])('"%s" means nothing', (text) => {
  expect(readFolds(() => shelfOf(text)).size).toBe(0);
});

test('aBrowserWithoutAShelfForgets', () => {
  const forbidden = (): never => {
    throw new Error('SecurityError');
  };
  for (const shelf of [forbidden, (): null => null, (): undefined => undefined]) {
    expect(() => keepFolds(shelf, new Map([['view', true]]))).not.toThrow();
    expect(readFolds(shelf).size).toBe(0);
  }
});
