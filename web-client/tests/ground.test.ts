import {expect, test} from 'vitest';
import {showGround} from '../viewer/page/ground';
import {groundStyle} from '../viewer/settings/ground';

/** As an element's style. */
class Properties extends Map<string, string> {
  setProperty(name: string, value: string): void {
    this.set(name, value);
  }
  removeProperty(name: string): void {
    this.delete(name);
  }
}

test('everyGroundHasInkThatIsReadOnIt', () => {
  const isLight = (ground: string): boolean => groundStyle(ground)['scene-ink'] === '#e9eef5';
  for (const dark of ['dark', '000000', '7f7f7f']) expect(isLight(dark), dark).toBe(true);
  for (const light of ['light', 'white', '808080', 'ffffff']) expect(isLight(light)).toBe(false);
});

test('thePagesOwnPropertiesStay', () => {
  const style = new Properties([
    ['--back', 'red'],
    ['--ground', 'blue'],
  ]);
  const page = new Map(style);
  const element = {style} as unknown as HTMLElement;
  showGround(element, '3c3c3c');
  expect(style.get('--own-ground')).toBe('#3c3c3c');
  expect(style.get('--back')).toBe('red');
  showGround(element, null);
  expect(new Map(style)).toEqual(page);
});
