// Where a build finds the WebAssembly modules that client.ts imports.

import {dirname, join} from 'node:path';

/** `codec` is the file of the whole codec. The one for the base mesh lies beside it. */
export const wasmModules = (codec: string): {find: RegExp; replacement: string}[] => [
  {find: /^qtet-codec\.wasm/, replacement: codec},
  {find: /^qtet-base\.wasm/, replacement: join(dirname(codec), 'qtet-base.wasm')},
];
