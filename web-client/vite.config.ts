// Builds the demo page. QTET_WASM names the codec's WebAssembly (CMake builds it and qtet-base.wasm
// beside it), QTET_VIEWER_OUT the folder to write.

import {defineConfig} from 'vitest/config';
import {notices} from './notices';
import {plainDynamicImports} from './plain_imports';
import {preloads} from './preloads';
import {smallShaders} from './small_shaders';
import {viewerFiles} from './viewer_files';
import {wasmModules} from './wasm_modules';

const wasm = process.env.QTET_WASM ?? 'qtet-codec.wasm';
/** A test that takes longer hangs: far beyond what any takes, also on a machine that is busy. */
const kHangMs = 120_000;

export default defineConfig({
  plugins: [smallShaders(), plainDynamicImports(), notices(), preloads(), viewerFiles()],
  base: './',
  resolve: {
    alias: wasmModules(wasm),
  },
  worker: {format: 'es', plugins: () => [smallShaders()]},
  build: {
    target: 'es2022',
    outDir: process.env.QTET_VIEWER_OUT ?? 'dist',
    emptyOutDir: true,
    // a data: address would prevent compiling WebAssembly while it downloads
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 700,
    modulePreload: {polyfill: false},
    reportCompressedSize: false,
  },
  test: {
    environment: 'node',
    include: ['tests/**/*.test.ts'],
    testTimeout: kHangMs,
    hookTimeout: kHangMs,
  },
});
