// Puts a whole log through the assembler, block by block, as the worker does. Needs the built
// codec, which QTET_WASM names (ctest sets it).

import {readFileSync} from 'node:fs';
import {Assembler} from '../core/decode/assembler';
import {headBytesOf} from '../core/transport/block_source';
import {WasmCodec} from '../core/decode/codec';
import type {ValueDecoder} from '../core/decode/draco';
import {QtetError} from '../core/protocol/errors';
import {kFirstFieldPart, kHeadPart} from '../core/protocol/parts';

/** If empty, tests that need it are skipped. */
export const kTestWasm = process.env.QTET_WASM ?? '';

/**
 * `module` is the whole codec's by default. Throws `truncated`, and the errors of the assembler and
 * the codec.
 */
export async function takeWholeLog(
  log: Uint8Array,
  values: ValueDecoder,
  module?: WebAssembly.Module,
): Promise<Assembler> {
  const codec = new WasmCodec(module ?? (await WebAssembly.compile(readFileSync(kTestWasm))));
  const assembler = new Assembler(codec, values);
  const headBytes = headBytesOf(log);
  assembler.take({
    stream: 1,
    chunk: 0,
    firstPart: kHeadPart,
    parts: 0,
    payload: log.subarray(0, headBytes),
  });
  const takeParts = (first: number): void => {
    const parts = kFirstFieldPart + assembler.manifest!.fields.length - first;
    for (let chunk = 0; chunk < codec.chunkCount; ++chunk) {
      const begin = codec.blockOffset(chunk, first);
      let end = begin;
      for (let part = first; part < first + parts; ++part) end += codec.blockSize(chunk, part);
      if (end > log.length)
        throw new QtetError('truncated', `chunk ${chunk} ends at ${end} of ${log.length} bytes`);
      assembler.take({
        stream: 1,
        chunk,
        firstPart: first,
        parts,
        payload: log.subarray(begin, end),
      });
    }
    const fields = assembler.manifest!.fields.map((_, field) => field);
    while (assembler.step(fields, true)) continue;
  };
  takeParts(0);
  const {laterBytes} = assembler;
  if (laterBytes > 0) {
    const known = assembler.manifest!.fields.length;
    assembler.takeLater(log.subarray(-laterBytes));
    takeParts(kFirstFieldPart + known);
  }
  return assembler;
}
