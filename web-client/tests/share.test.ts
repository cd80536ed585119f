import {expect, test} from 'vitest';
import {embedSnippet, linkTo, publicAddress} from '../viewer/settings/share';

test('aLinkHoldsTheViewAndNothingOfWhatStoodThereBefore', () => {
  const link = linkTo(
    'http://a.org/v/?mesh=old&x=1#part',
    new Map([
      ['mesh', 'fin & co'],
      ['clip', 'x:0.5 -z:1'],
    ]),
  );
  expect([...new URL(link).searchParams]).toEqual([
    ['mesh', 'fin & co'],
    ['clip', 'x:0.5 -z:1'],
  ]);
  expect(link).toMatch(/^http:\/\/a\.org\/v\/\?/);
});

test('aPageOnADiskTellsNoFolders', () => {
  expect(publicAddress('file:///home/me/secret/part.html?mesh=part')).toBe('file:///');
  expect(publicAddress('http://a.org/v/?mesh=a')).toBe('http://a.org/v/?mesh=a');
});

test('theLinesForAnotherPageAreOneFrameWhateverTheNames', () => {
  const lines = embedSnippet('http://a.org/?mesh=a&field="b"', 'View of "<x>"');
  expect(lines).toContain('src="http://a.org/?mesh=a&amp;field=&quot;b&quot;"');
  expect(lines).toContain('title="View of &quot;&lt;x>&quot;"');
});
