// Builds the demo page. QTET_WASM names the codec's WebAssembly (CMake builds it), QTET_VIEWER_OUT
// the folder to write.

import type {Plugin} from 'vite';
import {defineConfig} from 'vitest/config';
import {notices} from './notices';

const wasm = process.env.QTET_WASM ?? 'qtet-codec.wasm';

/**
 * No minifier touches shaders. Without comments and indents the viewer weighs 1.3 kB less (gzip).
 */
const smallShaders = (): Plugin => ({
  name: 'small-shaders',
  apply: 'build',
  enforce: 'pre',
  transform(code, id) {
    if (!id.endsWith('.ts') || !code.includes('/* glsl */')) return null;
    const small = code.replace(/\/\* glsl \*\/ `[^`]*`/g, (shader) =>
      shader.replace(/\/\/.*/g, '').replace(/\s*\n\s*/g, '\n'),
    );
    return {code: small, map: null};
  },
});

export default defineConfig({
  plugins: [smallShaders(), notices()],
  base: './',
  resolve: {
    alias: [{find: /^qtet-codec\.wasm/, replacement: wasm}],
  },
  worker: {format: 'es', plugins: () => [smallShaders()]},
  build: {
    target: 'es2022',
    outDir: process.env.QTET_VIEWER_OUT ?? 'dist',
    emptyOutDir: true,
    // a data: address would prevent compiling WebAssembly while it downloads
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 700,
    reportCompressedSize: false,
  },
  test: {environment: 'node', include: ['tests/**/*.test.ts']},
});
