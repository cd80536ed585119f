// Builds the demo page. QTET_WASM names the codec's WebAssembly (CMake builds it), QTET_VIEWER_OUT
// the folder to write.

import {defineConfig} from 'vitest/config';

const wasm = process.env.QTET_WASM ?? 'qtet-codec.wasm';

export default defineConfig({
  base: './',
  resolve: {
    alias: [{find: /^qtet-codec\.wasm/, replacement: wasm}],
  },
  worker: {format: 'es'},
  build: {
    target: 'es2022',
    outDir: process.env.QTET_VIEWER_OUT ?? 'dist',
    emptyOutDir: true,
    // WebAssembly is compiled while it downloads, which a data: address would prevent
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 700,
    reportCompressedSize: false,
  },
  test: {environment: 'node', include: ['tests/**/*.test.ts']},
});
