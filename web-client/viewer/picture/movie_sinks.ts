// The files of a movie: WebM where the browser encodes it, else a .zip of pictures.

import type {Sink} from './film';
import {webm, type WebmFrame, type WebmTrack} from './webm';
import {Zip} from './zip';

/** Thin lines on even grounds stay sharp with so many bits a pixel. */
const kBitsPerPixel = 0.3;
/** From one key frame to the next: so far a player decodes to seek. */
const kKeySeconds = 2;
/** Frames that the encoder may hold. */
const kMaxQueue = 2;
const kPollMs = 10;
/** Levels of VP9 by pixels of a picture (libvpx's vp9_level_defs). */
const kLevels: readonly [number, string][] = [
  [2228224, '40'],
  [8912896, '50'],
  [Infinity, '60'],
];

type Format = Pick<WebmTrack, 'width' | 'height' | 'framesPerSecond'>;

/** `name` is that of the pictures in a .zip. */
export async function openSink(format: Format, name: string): Promise<Sink> {
  const {width, height, framesPerSecond: framerate} = format;
  const level = kLevels.find(([most]) => width * height <= most)![1];
  const codecs = [
    ['V_VP9', `vp09.00.${level}.08`],
    ['V_VP8', 'vp8'],
  ] as const;
  for (const [id, codec] of codecs) {
    const bitrate = Math.round(kBitsPerPixel * width * height * framerate);
    const config: VideoEncoderConfig = {codec, width, height, bitrate, framerate};
    if (await isSupported(config)) return new WebmSink({...format, codec: id}, config);
  }
  return new ZipSink(name);
}

/** Pages without https have no encoder. */
async function isSupported(config: VideoEncoderConfig): Promise<boolean> {
  if (!('VideoEncoder' in globalThis)) return false;
  return VideoEncoder.isConfigSupported(config).then(
    ({supported}) => supported === true,
    () => false,
  );
}

class WebmSink implements Sink {
  readonly isOpaque = true;
  private readonly encoder: VideoEncoder;
  private readonly frames: WebmFrame[] = [];
  private error: Error | null = null;
  private count = 0;

  constructor(
    private readonly track: WebmTrack,
    config: VideoEncoderConfig,
  ) {
    this.encoder = new VideoEncoder({
      output: (chunk, metadata) => this.take(chunk, metadata),
      error: ({message}) => {
        this.error = new Error(`The browser's encoder has failed: ${message}`);
      },
    });
    this.encoder.configure(config);
  }

  async add(canvas: OffscreenCanvas): Promise<void> {
    const {encoder, track} = this;
    if (this.error) throw this.error;
    const frameUs = 1e6 / track.framesPerSecond;
    const i = this.count++;
    const timestamp = Math.round(i * frameUs);
    const frame = new VideoFrame(canvas, {timestamp, duration: Math.round(frameUs)});
    try {
      encoder.encode(frame, {keyFrame: i % (kKeySeconds * track.framesPerSecond) === 0});
    } finally {
      frame.close();
    }
    // A failure empties the queue.
    while (encoder.encodeQueueSize > kMaxQueue)
      await new Promise((resolve) => setTimeout(resolve, kPollMs));
  }

  async end(): Promise<Blob> {
    await this.encoder.flush().catch((thrown: unknown) => {
      throw this.error ?? thrown;
    });
    if (this.error) throw this.error;
    if (this.frames.length !== this.count)
      throw new Error("The browser's encoder has lost a frame.");
    return new Blob(webm(this.track, this.frames), {type: 'video/webm'});
  }

  close(): void {
    if (this.encoder.state !== 'closed') this.encoder.close();
  }

  private take(chunk: EncodedVideoChunk, metadata?: EncodedVideoChunkMetadata): void {
    const color = metadata?.decoderConfig?.colorSpace;
    if (color) this.track.color = color;
    const data = new Uint8Array(chunk.byteLength);
    chunk.copyTo(data);
    const timeMs = Math.round(chunk.timestamp / 1000);
    this.frames.push({timeMs, isKey: chunk.type === 'key', data});
  }
}

class ZipSink implements Sink {
  readonly isOpaque = false;
  private readonly zip = new Zip();
  private count = 0;

  constructor(private readonly name: string) {}

  async add(canvas: OffscreenCanvas): Promise<void> {
    const number = String(++this.count).padStart(4, '0');
    const png = await canvas.convertToBlob({type: 'image/png'});
    await this.zip.add(`${this.name}-${number}.png`, png);
  }

  async end(): Promise<Blob> {
    return this.zip.end();
  }

  close(): void {
    return;
  }
}
