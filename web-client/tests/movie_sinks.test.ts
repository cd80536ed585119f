import {afterEach, beforeEach, expect, test, vi} from 'vitest';
import {openSink} from '../viewer/picture/movie_sinks';

interface Output {
  output(chunk: unknown, metadata?: unknown): void;
  error(error: Error): void;
}

let supported: string[];
let frames: {timestamp: number; isClosed: boolean}[];
let encoders: FakeEncoder[];

class FakeEncoder {
  static isConfigSupported({codec}: {codec: string}): Promise<{supported: boolean}> {
    return Promise.resolve({supported: supported.some((name) => codec.startsWith(name))});
  }
  state = 'configured';
  encodeQueueSize = 0;
  readonly keys: boolean[] = [];
  constructor(readonly its: Output) {
    encoders.push(this);
  }
  configure(): void {
    return;
  }
  encode({timestamp}: {timestamp: number}, {keyFrame}: {keyFrame: boolean}): void {
    this.keys.push(keyFrame);
    const type = keyFrame ? 'key' : 'delta';
    this.its.output({timestamp, type, byteLength: 1, copyTo: () => undefined});
  }
  async flush(): Promise<void> {
    return;
  }
  close(): void {
    this.state = 'closed';
  }
}

class FakeFrame {
  readonly its: (typeof frames)[number];
  readonly timestamp: number;
  constructor(_: unknown, {timestamp}: {timestamp: number}) {
    this.timestamp = timestamp;
    this.its = {timestamp, isClosed: false};
    frames.push(this.its);
  }
  close(): void {
    this.its.isClosed = true;
  }
}

beforeEach(() => {
  supported = ['vp09', 'vp8'];
  [frames, encoders] = [[], []];
  vi.stubGlobal('VideoEncoder', FakeEncoder);
  vi.stubGlobal('VideoFrame', FakeFrame);
});
afterEach(() => void vi.unstubAllGlobals());

const kFormat = {width: 64, height: 48, framesPerSecond: 5};
const canvas = {
  convertToBlob: () => Promise.resolve(new Blob(['png'])),
} as unknown as OffscreenCanvas;

test('theBestFormatThatTheBrowserEncodesIsTaken', async () => {
  const kinds: string[] = [];
  for (const codecs of [['vp8', 'vp09'], ['vp8'], []]) {
    supported = codecs;
    const sink = await openSink(kFormat, 'fin');
    await sink.add(canvas);
    const movie = await sink.end();
    const text = await movie.text();
    kinds.push(`${movie.type} ${/V_VP\d|fin-0001.png/.exec(text)![0]} ${sink.isOpaque}`);
  }
  expect(kinds).toEqual([
    'video/webm V_VP9 true',
    'video/webm V_VP8 true',
    'application/zip fin-0001.png false',
  ]);
});

test('everyTwoSecondsAreAKeyAndAllFramesAreClosed', async () => {
  const sink = await openSink(kFormat, 'fin');
  for (let i = 0; i < 21; ++i) await sink.add(canvas);
  sink.close();
  const keys = encoders[0]!.keys.flatMap((isKey, i) => (isKey ? [i] : []));
  expect(keys).toEqual([0, 10, 20]);
  expect(frames.map(({timestamp}) => timestamp).slice(0, 3)).toEqual([0, 200000, 400000]);
  expect(frames.every(({isClosed}) => isClosed)).toBe(true);
  expect(encoders[0]!.state).toBe('closed');
});

test('aFailureOfTheEncoderAndALostFrameAreTold', async () => {
  const sink = await openSink(kFormat, 'fin');
  encoders[0]!.its.error(new Error('no memory'));
  await expect(sink.add(canvas)).rejects.toThrow(/encoder has failed: no memory/);
  await expect(sink.end()).rejects.toThrow(/encoder has failed: no memory/);
  const other = await openSink(kFormat, 'fin');
  encoders[1]!.its.output = () => undefined;
  await other.add(canvas);
  await expect(other.end()).rejects.toThrow(/lost a frame/);
});
