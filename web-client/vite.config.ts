// Builds the demo page. QTET_WASM names the codec's WebAssembly (CMake builds it), QTET_VIEWER_OUT the folder to write.

import {fileURLToPath} from 'node:url';
import {defineConfig} from 'vitest/config';

const wasm = process.env.QTET_WASM ?? 'qtet-codec.wasm';
const noNode = fileURLToPath(new URL('core/no_node.ts', import.meta.url));

export default defineConfig(({mode}) => ({
  base: './',
  resolve: {
    alias: [
      {find: /^qtet-codec\.wasm/, replacement: wasm},
      ...(mode === 'test' ? [] : [{find: 'node:fs', replacement: noNode}]),
    ],
  },
  worker: {format: 'es'},
  build: {
    target: 'es2022',
    outDir: process.env.QTET_VIEWER_OUT ?? 'dist',
    emptyOutDir: true,
    assetsInlineLimit: 0,  // WebAssembly is compiled while it downloads, which a data: address would prevent
    chunkSizeWarningLimit: 700,
    reportCompressedSize: false,
  },
  test: {environment: 'node', include: ['tests/**/*.test.ts']},
}));
