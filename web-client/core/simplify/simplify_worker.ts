// The worker that simplifies one mesh file, and ends.

import {loadingCause} from '../protocol/wasm_policy';
import {errorCode, errorText} from '../protocol/errors';
import type {PageFile} from './page_files';
import {simplifyFile, type SimplifiedFile, type SimplifyProgress} from './simplify_file';

export interface SimplifyRequest {
  moduleUrl: string;
  files: File[];
  /** The file to read; the others are those that it names. */
  name: string;
}

export type SimplifyMessage =
  | ({type: 'progress'} & SimplifyProgress)
  | ({type: 'done'} & SimplifiedFile)
  | {type: 'failed'; code: string; message: string};

/** A worker's own, which TypeScript's types of pages lack. */
declare class FileReaderSync {
  readAsArrayBuffer(blob: Blob): ArrayBuffer;
}

/** A reader asks for a few kilobytes at a time; each request of a file takes its time. */
const kWindowBytes = 1 << 20;

/** A file of this machine, read by ranges. */
class LocalFile implements PageFile {
  readonly name: string;
  readonly size: number;
  private readonly reader = new FileReaderSync();
  private window = new Uint8Array();
  private from = 0;

  constructor(private readonly file: File) {
    this.name = file.name;
    this.size = file.size;
  }

  read(at: number, length: number): Uint8Array {
    if (at < this.from || at + length > this.from + this.window.length) {
      const end = at + Math.max(length, kWindowBytes);
      this.window = new Uint8Array(this.reader.readAsArrayBuffer(this.file.slice(at, end)));
      this.from = at;
    }
    return this.window.subarray(at - this.from, at - this.from + length);
  }
}

async function compiled(url: string): Promise<WebAssembly.Module> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${response.status} ${response.statusText}`);
  const bytes = await response.arrayBuffer();
  if (bytes.byteLength === 0)
    throw new Error('this viewer was built without it; `make build` adds it');
  return WebAssembly.compile(bytes);
}

const post = (message: SimplifyMessage, buffers: Transferable[] = []): void =>
  self.postMessage(message, {transfer: buffers});

async function serve({moduleUrl, files, name}: SimplifyRequest): Promise<void> {
  let module;
  try {
    module = await compiled(moduleUrl);
  } catch (thrown) {
    return post({
      type: 'failed',
      code: 'no-simplifier',
      message:
        `What simplifies meshes cannot be loaded (${loadingCause(thrown)}). Make a log by ` +
        '`qtet simplify` and drop that.',
    });
  }
  try {
    const pageFiles = files.map((file) => new LocalFile(file));
    const made = simplifyFile(module, pageFiles, name, (progress) =>
      post({type: 'progress', ...progress}),
    );
    post({type: 'done', ...made}, [made.log.buffer]);
  } catch (thrown) {
    post({type: 'failed', code: errorCode(thrown), message: errorText(thrown)});
  }
}

self.onmessage = (event: MessageEvent<SimplifyRequest>) => void serve(event.data);
