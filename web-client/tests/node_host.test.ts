// Names of files between Windows and the tool, which knows those of POSIX alone.

import {expect, test} from 'vitest';
import {hostName, toolName, toolWord} from '../tool/node_host';

test('names of Windows', () => {
  expect(toolName('c:\\data\\part.vtu', true)).toBe('/C/data/part.vtu');
  expect(toolName('data\\part.vtu', true)).toBe('data/part.vtu');
  expect(hostName('/C/data/part.vtu', true)).toBe('C:\\data\\part.vtu');
  expect(hostName('/C', true)).toBe('C:\\');
  expect(toolName('\\\\server\\share\\part.vtu', true)).toBe('/UNC/server/share/part.vtu');
  expect(hostName('/UNC/server/share/part.vtu', true)).toBe('\\\\server\\share\\part.vtu');
});

test('other systems keep their names', () => {
  expect(toolName('/data/a\\b.vtu', false)).toBe('/data/a\\b.vtu');
  expect(hostName('/C/data', false)).toBe('/C/data');
});

test('words with names', () => {
  expect(toolWord('--output=c:\\a.qtet', true)).toBe('--output=/C/a.qtet');
  expect(toolWord('-o', true)).toBe('-o');
  expect(toolWord('point:a\\,b', true)).toBe('point:a\\,b');
});
