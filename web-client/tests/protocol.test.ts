import {describe, expect, test} from 'vitest';
import {kHeadPart} from '../core/protocol/parts';
import {QtetError} from '../core/protocol/errors';
import {
  kFrameHeaderBytes,
  openMessage,
  parseFrame,
  parseServerMessage,
} from '../core/protocol/messages';

function frameBytes(payload: number[], size = payload.length): ArrayBuffer {
  const bytes = new Uint8Array(kFrameHeaderBytes + payload.length);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, 7, true);
  view.setUint32(4, 0x01020304, true);
  view.setUint16(8, kHeadPart, true);
  view.setUint16(10, 3, true);
  view.setUint32(12, size, true);
  bytes.set(payload, kFrameHeaderBytes);
  return bytes.buffer;
}

function codeOf(action: () => unknown): string {
  try {
    action();
  } catch (thrown) {
    return thrown instanceof QtetError ? thrown.code : `not a QtetError: ${String(thrown)}`;
  }
  return 'nothing thrown';
}

describe('binary frames', () => {
  test('everyFieldOfTheHeaderIsReadLittleEndian', () => {
    expect(parseFrame(frameBytes([9, 8]))).toEqual({
      stream: 7,
      chunk: 0x01020304,
      firstPart: kHeadPart,
      parts: 3,
      payload: new Uint8Array([9, 8]),
    });
  });

  test('aPayloadMayBeEmpty', () => {
    expect(parseFrame(frameBytes([])).payload).toHaveLength(0);
  });

  test('everyTruncationIsRefused', () => {
    const whole = frameBytes([1, 2, 3]);
    for (let size = 0; size < whole.byteLength; ++size)
      expect(codeOf(() => parseFrame(whole.slice(0, size)))).toBe('bad-message');
  });

  test('aSizeThatDiffersFromThePayloadIsRefused', () => {
    for (const size of [0, 2, 4, 0xffffffff])
      expect(codeOf(() => parseFrame(frameBytes([1, 2, 3], size)))).toBe('bad-message');
  });
});

describe('server messages', () => {
  test('openedIsReadWhole', () => {
    const message = {type: 'opened', stream: 2, mesh: 'fin', digest: 'ab', bytes: 10, planned: 5};
    expect(parseServerMessage(JSON.stringify(message))).toEqual(message);
  });

  test('doneStoppedAndErrorAreRead', () => {
    expect(parseServerMessage('{"type":"done","stream":1}')).toEqual({type: 'done', stream: 1});
    expect(parseServerMessage('{"type":"stopped","stream":1}')).toEqual({
      type: 'stopped',
      stream: 1,
    });
    expect(parseServerMessage('{"type":"error","code":"not-found","detail":"d"}')).toEqual({
      type: 'error',
      code: 'not-found',
      detail: 'd',
    });
  });

  test('anUnknownTypeIsIgnored', () => {
    expect(parseServerMessage('{"type":"later"}')).toBeNull();
  });

  test.each([
    '',
    '{',
    '3',
    'null',
    '{"type":"done"}',
    '{"type":"done","stream":-1}',
    '{"type":"done","stream":1.5}',
    '{"type":"error","code":1,"detail":""}',
    '{"type":"opened","stream":1,"mesh":"m","digest":"d","bytes":"1","planned":0}',
  ])('brokenMessage %s isRefused', (text) =>
    expect(codeOf(() => parseServerMessage(text))).toBe('bad-message'),
  );
});

test('openCarriesHaveAndDigest', () => {
  const request = {
    mesh: 'm',
    fields: ['p'],
    have: {chunks: 3, fields: {p: 2}},
    credit: 9,
    digest: 'd',
  };
  expect(JSON.parse(openMessage(request))).toEqual({type: 'open', ...request});
});
