import {expect, test} from 'vitest';
import {openView, parametersIn} from '../viewer/picture/open_view';
import {withTexts} from '../viewer/picture/png_view';
import type {Page} from '../viewer/page/page';

test('onlyParametersOfAViewAreTakenFromAnAddress', () => {
  const address =
    'https://evil.example/x?src=https://evil.example/a.qtet&transport=range&token=t&mesh=fin' +
    '&field=p%20%26%20q&clip=&constructor=1#mesh=other';
  expect([...parametersIn(address)]).toEqual([
    ['mesh', 'fin'],
    ['field', 'p & q'],
  ]);
  for (const none of ['', '?', 'https://a.org/', 'mesh=fin', 'javascript:alert(1)', 'a#?mesh=b'])
    expect([...parametersIn(none)]).toEqual([]);
});

/** Opens the view of a picture on a page that shows `shown`. Returns what happens. */
async function opened(file: Blob, shown: string): Promise<string[]> {
  const log: string[] = [];
  const page = {
    root: {querySelector: () => ({value: shown})},
    write: (name: string, value: string | null) => {
      if (value !== null || name === 'camera') log.push(`${name}=${value}`);
    },
    announce: () => undefined,
  } as unknown as Page;
  await openView(file, page, {
    stream: {choose: (mesh) => log.push(`choose ${mesh}`)},
    notices: {end: () => undefined},
    look: () => log.push('first view'),
    failed: (code, message) => log.push(`${code}: ${message}`),
  });
  return log;
}

const picture = (address: string): Blob => withTexts(new Blob([kPng]), address);
const kPng = Uint8Array.from(
  atob(
    'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNgAAAAAgABSK+kcQAAAABJRU5ErkJggg==',
  ),
  (letter) => letter.charCodeAt(0),
);

test('thePictureOfTheSameMeshMovesTheCameraThatTheUserHasTurned', async () => {
  const address = 'https://a.org/?mesh=fin&field=p&camera=1,2,3,4,5,6';
  expect(await opened(picture(address), 'fin')).toEqual([
    'field=p',
    'camera=null',
    'camera=1,2,3,4,5,6',
  ]);
  expect(await opened(picture('?mesh=fin&edges=off'), 'fin')).toEqual([
    'edges=off',
    'camera=null',
    'first view',
  ]);
});

test('anotherMeshIsOpenedBeforeItsAttributesAreWritten', async () => {
  expect(await opened(picture('?mesh=box&scale=log'), 'fin')).toEqual([
    'choose box',
    'scale=log',
    'camera=null',
  ]);
});

test('aPictureWithoutAViewChangesNothingAndIsTold', async () => {
  expect(await opened(new Blob([kPng]), 'fin')).toEqual([
    expect.stringMatching(/^no-picture: The picture holds no view/),
  ]);
});
