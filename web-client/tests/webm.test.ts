import {expect, test} from 'vitest';
import {webm, type WebmFrame, type WebmTrack} from '../viewer/picture/webm';

interface Element {
  id: string;
  /** The place of its content in the file. */
  start: number;
  end: number;
}

/** IDs of elements that hold elements. */
const kMasters = ['1a45dfa3', '18538067', '1549a966', '1654ae6b', 'ae', 'e0', '55b0'];
kMasters.push('1c53bb6b', 'bb', 'b7', '1f43b675');

/** All elements in their order; each ends exactly where its parent says. */
function elementsIn(file: DataView<ArrayBuffer>, start = 0, end = file.byteLength): Element[] {
  const found: Element[] = [];
  for (let at = start; at < end;) {
    const idBytes = Math.clz32(file.getUint8(at)) - 23;
    const id = [...new Uint8Array(file.buffer, at, idBytes)];
    at += idBytes;
    const sizeBytes = Math.clz32(file.getUint8(at)) - 23;
    let size = BigInt(file.getUint8(at)) & BigInt((1 << (8 - sizeBytes)) - 1);
    for (let i = 1; i < sizeBytes; ++i) size = (size << 8n) | BigInt(file.getUint8(at + i));
    at += sizeBytes;
    const its = {id: Buffer.from(id).toString('hex'), start: at, end: at + Number(size)};
    expect(its.end).toBeLessThanOrEqual(end);
    found.push(its);
    if (kMasters.includes(its.id)) found.push(...elementsIn(file, its.start, its.end));
    at = its.end;
  }
  return found;
}

interface Parsed {
  file: DataView<ArrayBuffer>;
  elements: Element[];
  of: (id: string) => Element[];
  number: (its: Element) => number;
  text: (its: Element) => string;
}

async function parsed(track: WebmTrack, frames: WebmFrame[]): Promise<Parsed> {
  const file = new DataView(await new Blob(webm(track, frames)).arrayBuffer());
  const elements = elementsIn(file);
  const of = (id: string): Element[] => elements.filter((its) => its.id === id);
  const number = ({start, end}: Element): number => {
    let value = 0n;
    for (let at = start; at < end; ++at) value = (value << 8n) | BigInt(file.getUint8(at));
    return Number(value);
  };
  const text = ({start, end}: Element): string =>
    Buffer.from(file.buffer.slice(start, end)).toString();
  return {file, elements, of, number, text};
}

const kTrack: WebmTrack = {codec: 'V_VP9', width: 640, height: 480, framesPerSecond: 25};

/** Every `every`-th is a key. Each has another length. */
const framesOf = (count: number, every: number, framesPerSecond = 25): WebmFrame[] =>
  Array.from({length: count}, (_, i) => ({
    timeMs: Math.round((1000 * i) / framesPerSecond),
    isKey: i % every === 0,
    data: new Uint8Array(i + 1).fill(i),
  }));

test('theHeadSaysWhatTheTrackIs', async () => {
  const {file, elements, of, number, text} = await parsed(kTrack, framesOf(120, 50));
  expect(elements.filter(({id}) => id.length === 8).map(({id}) => id)).toEqual(
    ['1a45dfa3', '18538067', '1549a966', '1654ae6b', '1c53bb6b'].concat(
      Array<string>(3).fill('1f43b675'),
    ),
  );
  expect(of('18538067')[0]!.end).toBe(file.byteLength);
  expect(text(of('4282')[0]!)).toBe('webm');
  expect(number(of('2ad7b1')[0]!)).toBe(1e6);
  expect(file.getFloat64(of('4489')[0]!.start)).toBe(4800);
  expect(text(of('86')[0]!)).toBe('V_VP9');
  expect(number(of('23e383')[0]!)).toBe(40e6);
  expect([number(of('b0')[0]!), number(of('ba')[0]!)]).toEqual([640, 480]);
  expect(of('55b0')).toEqual([]);
});

test('eachBlockHasItsTimeItsKeyAndItsBytes', async () => {
  for (const framesPerSecond of [1, 7, 25]) {
    const frames = framesOf(30, 2 * framesPerSecond, framesPerSecond);
    const track = {...kTrack, framesPerSecond};
    const {file, elements, number} = await parsed(track, frames);
    let cluster = 0;
    const read: WebmFrame[] = [];
    for (const its of elements) {
      if (its.id === 'e7') cluster = number(its);
      if (its.id !== 'a3') continue;
      expect(file.getUint8(its.start)).toBe(0x81);
      read.push({
        timeMs: cluster + file.getInt16(its.start + 1),
        isKey: file.getUint8(its.start + 3) === 0x80,
        data: new Uint8Array(file.buffer.slice(its.start + 4, its.end)),
      });
    }
    expect(read).toEqual(frames);
  }
});

test('eachCuePointsAtAClusterThatBeginsWithItsKey', async () => {
  const {file, elements, of, number} = await parsed(kTrack, framesOf(120, 50));
  const segment = of('18538067')[0]!.start;
  const times = of('b3').map(number);
  expect(times).toEqual([0, 2000, 4000]);
  of('f1').forEach((cue, i) => {
    const at = segment + number(cue);
    expect(file.getUint32(at)).toBe(0x1f43b675);
    const [time, block] = elements.filter(({start}) => start > at).slice(1);
    expect(number(time!)).toBe(times[i]);
    expect(file.getUint32(block!.start)).toBe(0x81000080);
  });
});

test('aColourHasTheNumbersOfTheStandard', async () => {
  const color = {matrix: 'bt709', fullRange: false, primaries: 'bt709', transfer: 'other'};
  const {of, number} = await parsed(
    {...kTrack, color: color as unknown as VideoColorSpaceInit},
    framesOf(1, 1),
  );
  expect(['55b1', '55b9', '55ba', '55bb'].map((id) => number(of(id)[0]!))).toEqual([1, 1, 2, 1]);
});
