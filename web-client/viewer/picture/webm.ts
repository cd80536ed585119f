// A WebM file of one video track. Matroska is RFC 9559: sections 5.1.2 (Info), 5.1.3 (Cluster),
// 5.1.4 (Tracks), 5.1.5 (Cues), 10.2 (SimpleBlock), 16 (Segment Position), 25.3.3 (Cues in front).
// The EBML header is RFC 8794, section 11.2.

import {element, number, sizeOf, text, type Pieces} from './ebml';

export interface WebmTrack {
  codec: 'V_VP8' | 'V_VP9';
  width: number;
  height: number;
  framesPerSecond: number;
  color?: VideoColorSpaceInit | undefined;
}

export interface WebmFrame {
  timeMs: number;
  isKey: boolean;
  data: Uint8Array<ArrayBuffer>;
}

const kEbml = 0x1a45dfa3;
const kEbmlVersion = 0x4286;
const kEbmlReadVersion = 0x42f7;
const kEbmlMaxIdLength = 0x42f2;
const kEbmlMaxSizeLength = 0x42f3;
const kDocType = 0x4282;
const kDocTypeVersion = 0x4287;
const kDocTypeReadVersion = 0x4285;
const kSegment = 0x18538067;
const kInfo = 0x1549a966;
const kTimestampScale = 0x2ad7b1;
const kDuration = 0x4489;
const kMuxingApp = 0x4d80;
const kWritingApp = 0x5741;
const kTracks = 0x1654ae6b;
const kTrackEntry = 0xae;
const kTrackNumber = 0xd7;
const kTrackUid = 0x73c5;
const kTrackType = 0x83;
const kFlagLacing = 0x9c;
const kCodecId = 0x86;
const kDefaultDuration = 0x23e383;
const kVideo = 0xe0;
const kPixelWidth = 0xb0;
const kPixelHeight = 0xba;
const kColour = 0x55b0;
const kMatrix = 0x55b1;
const kRange = 0x55b9;
const kTransfer = 0x55ba;
const kPrimaries = 0x55bb;
const kCues = 0x1c53bb6b;
const kCuePoint = 0xbb;
const kCueTime = 0xb3;
const kCueTrackPositions = 0xb7;
const kCueTrack = 0xf7;
const kCueClusterPosition = 0xf1;
const kCluster = 0x1f43b675;
const kTimestamp = 0xe7;
const kSimpleBlock = 0xa3;

/** WebCodecs' names as the numbers of ISO/IEC 23091-4, which Matroska uses. */
const kColorNumbers: Record<string, number> = {
  rgb: 0,
  bt709: 1,
  bt470bg: 5,
  smpte170m: 6,
  'iec61966-2-1': 13,
};
const kUnspecified = 2;

/**
 * The parts of the file. REQUIRES: times ascend from 0, the first frame is a key, and from one key
 * to the next pass less than 32 s.
 */
export function webm(track: WebmTrack, frames: readonly WebmFrame[]): Pieces {
  const clusters: {timeMs: number; pieces: Pieces}[] = [];
  for (let at = 0; at < frames.length;) {
    let end = at + 1;
    while (end < frames.length && !frames[end]!.isKey) ++end;
    clusters.push(clusterOf(frames.slice(at, end)));
    at = end;
  }
  const head = [...info(track, frames.length), ...tracks(track)];
  // The cues' size does not depend on the positions in them.
  const positions = clusters.map(() => 0);
  const times = clusters.map(({timeMs}) => timeMs);
  let position = sizeOf(head) + sizeOf(cues(times, positions));
  clusters.forEach(({pieces}, i) => {
    positions[i] = position;
    position += sizeOf(pieces);
  });
  const body = clusters.flatMap(({pieces}) => pieces);
  return [...header(), ...element(kSegment, [...head, ...cues(times, positions), ...body])];
}

function header(): Pieces {
  return element(kEbml, [
    ...number(kEbmlVersion, 1),
    ...number(kEbmlReadVersion, 1),
    ...number(kEbmlMaxIdLength, 4),
    ...number(kEbmlMaxSizeLength, 8),
    ...text(kDocType, 'webm'),
    ...number(kDocTypeVersion, 4),
    ...number(kDocTypeReadVersion, 2),
  ]);
}

function info({framesPerSecond}: WebmTrack, count: number): Pieces {
  const duration = new DataView(new ArrayBuffer(8));
  duration.setFloat64(0, (1000 * count) / framesPerSecond);
  return element(kInfo, [
    ...number(kTimestampScale, 1e6), // in ns: times are in ms
    ...element(kDuration, [new Uint8Array(duration.buffer)]),
    ...text(kMuxingApp, 'qtet'),
    ...text(kWritingApp, 'qtet'),
  ]);
}

function tracks({codec, width, height, framesPerSecond, color}: WebmTrack): Pieces {
  return element(
    kTracks,
    element(kTrackEntry, [
      ...number(kTrackNumber, 1),
      ...number(kTrackUid, 1),
      ...number(kTrackType, 1), // video
      ...number(kFlagLacing, 0),
      ...text(kCodecId, codec),
      ...number(kDefaultDuration, Math.round(1e9 / framesPerSecond)),
      ...element(kVideo, [
        ...number(kPixelWidth, width),
        ...number(kPixelHeight, height),
        ...(color ? colour(color) : []),
      ]),
    ]),
  );
}

function colour({matrix, fullRange, transfer, primaries}: VideoColorSpaceInit): Pieces {
  const numberOf = (name: string | null | undefined): number =>
    kColorNumbers[name ?? ''] ?? kUnspecified;
  return element(kColour, [
    ...number(kMatrix, numberOf(matrix)),
    ...number(kRange, fullRange ? 2 : 1),
    ...number(kTransfer, numberOf(transfer)),
    ...number(kPrimaries, numberOf(primaries)),
  ]);
}

function cues(times: readonly number[], positions: readonly number[]): Pieces {
  const points = times.map((timeMs, i) =>
    element(kCuePoint, [
      ...number(kCueTime, timeMs),
      ...element(kCueTrackPositions, [
        ...number(kCueTrack, 1),
        ...number(kCueClusterPosition, positions[i]!),
      ]),
    ]),
  );
  return element(kCues, points.flat());
}

function clusterOf(frames: readonly WebmFrame[]): {timeMs: number; pieces: Pieces} {
  const {timeMs} = frames[0]!;
  const blocks = frames.flatMap((frame) => {
    const since = frame.timeMs - timeMs; // a signed number of 16 bits
    const head = [0x81, since >> 8, since, frame.isKey ? 0x80 : 0];
    return element(kSimpleBlock, [new Uint8Array(head), frame.data]);
  });
  return {timeMs, pieces: element(kCluster, [...number(kTimestamp, timeMs), ...blocks])};
}
