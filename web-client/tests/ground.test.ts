import {expect, test} from 'vitest';
import {showColor} from '../viewer/panels/ground_panel';

/** As an element's style: an empty value removes the property. */
class Properties extends Map<string, string> {
  setProperty(name: string, value: string): void {
    if (value === '') this.delete(name);
    else this.set(name, value);
  }
}

const shownOn = (style: Properties, color: string | null): Properties => {
  showColor({style} as unknown as HTMLElement, color);
  return style;
};

test('everyColourHasInkThatIsReadOnIt', () => {
  const isLight = (color: string): boolean =>
    shownOn(new Properties(), color).get('--scene-ink') === '#e9eef5';
  for (const dark of ['000000', '7f7f7f', '0000ff']) expect(isLight(dark), dark).toBe(true);
  for (const light of ['808080', 'ffffff', 'ffff00']) expect(isLight(light), light).toBe(false);
});

test('thePagesOwnPropertiesStay', () => {
  const page = [
    ['--back', 'red'],
    ['--ground', 'blue'],
  ] as const;
  const style = new Properties(page);
  expect(shownOn(style, '3c3c3c').get('--own-ground')).toBe('#3c3c3c');
  expect(style.get('--back')).toBe('red');
  expect([...shownOn(style, null)]).toEqual(page);
});
