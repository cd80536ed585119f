// Where a build finds the WebAssembly modules that client.ts imports.

import {dirname, join} from 'node:path';

/** `codec` is the file of the whole codec. Those for the base mesh and for meshes lie beside it. */
export const wasmModules = (codec: string): {find: RegExp; replacement: string}[] => [
  {find: /^qtet-codec\.wasm/, replacement: codec},
  {find: /^qtet-base\.wasm/, replacement: join(dirname(codec), 'qtet-base.wasm')},
  {find: /^qtet-simplify\.wasm/, replacement: join(dirname(codec), 'qtet-simplify.wasm')},
];
