import {beforeEach, expect, test} from 'vitest';
import {film, type Sink, type Stage} from '../viewer/picture/film';

let log: string[];
let stage: Stage;
let sink: Sink;
let ends: AbortController;

beforeEach(() => {
  log = [];
  ends = new AbortController();
  stage = {
    instants: [4, 2, 7],
    show: async (i, signal) => {
      signal.throwIfAborted();
      log.push(`show ${i}`);
    },
    draw: async () => ({}) as OffscreenCanvas,
    restore: () => void log.push('restore'),
  };
  sink = {
    isOpaque: true,
    add: async () => void log.push('add'),
    end: async () => {
      log.push('end');
      return new Blob(['movie']);
    },
    close: () => undefined,
  };
});

const made = (progress: (done: number, count: number) => void = () => undefined): Promise<Blob> =>
  film(stage, sink, {signal: ends.signal, progress});

test('eachInstantIsShownBeforeItIsAddedAndTheViewIsRestored', async () => {
  const told: number[][] = [];
  const movie = await made((...its) => void told.push(its));
  expect(await movie.text()).toBe('movie');
  const each = [0, 1, 2].flatMap((i) => [`show ${i}`, 'add']);
  expect(log).toEqual([...each, 'end', 'restore']);
  expect(told).toEqual([0, 1, 2, 3].map((done) => [done, 3]));
});

test('aCancelledMovieIsNotEnded', async () => {
  const making = made((done) => {
    if (done === 1) ends.abort();
  });
  await expect(making).rejects.toThrow(/abort/i);
  expect(log).toEqual(['show 0', 'add', 'restore']);
});

test('aMovieThatIsCancelledAtItsEndIsNotReturned', async () => {
  sink.end = async () => {
    ends.abort();
    return new Blob();
  };
  await expect(made()).rejects.toThrow(/abort/i);
  expect(log.at(-1)).toBe('restore');
});

test('cancellingDoesNotWaitForAPicture', async () => {
  stage.draw = () => new Promise(() => undefined);
  const making = made();
  await Promise.resolve();
  ends.abort();
  await expect(making).rejects.toThrow(/abort/i);
  expect(log).toEqual(['show 0', 'restore']);
});

test('aFailureAnywhereRestoresTheView', async () => {
  const failing = async (): Promise<never> => {
    throw new Error('no');
  };
  const [wholeStage, wholeSink] = [stage, sink];
  for (const name of ['show', 'draw', 'add', 'end']) {
    log = [];
    const isOfSink = name in sink;
    stage = {...wholeStage, ...(!isOfSink && {[name]: failing})};
    sink = {...wholeSink, ...(isOfSink && {[name]: failing})};
    await expect(made()).rejects.toThrow('no');
    expect([log.at(-1), log.includes('end')]).toEqual(['restore', false]);
  }
});
