// Builds the npm package's modules: QTET_WASM names the codec's WebAssembly, QTET_PACKAGE_OUT the
// folder to write (pack.mjs sets both).

import {defineConfig, transformWithEsbuild} from 'vite';
import {notices} from './notices';
import {plainDynamicImports} from './plain_imports';
import {smallShaders} from './small_shaders';
import {wasmModules} from './wasm_modules';

export default defineConfig({
  base: './',
  publicDir: false, // it is the page's
  plugins: [plainDynamicImports(), notices(true)],
  resolve: {alias: wasmModules(process.env.QTET_WASM!)},
  // Bundlers copy workers' files unchanged. So these contain everything they need, and are minified
  // here.
  worker: {
    format: 'es',
    rollupOptions: {output: {entryFileNames: '[name].js', inlineDynamicImports: true}},
    plugins: () => [
      smallShaders(),
      {
        name: 'minify',
        async renderChunk(code: string) {
          const small = {minify: true, target: 'es2022'} as const;
          return {code: (await transformWithEsbuild(code, 'worker.js', small)).code, map: null};
        },
      },
    ],
  },
  build: {
    target: 'es2022',
    outDir: process.env.QTET_PACKAGE_OUT!,
    emptyOutDir: true,
    assetsInlineLimit: 0,
    minify: false, // the page that uses it minifies
    modulePreload: false,
    reportCompressedSize: false,
    rollupOptions: {
      input: {
        core: './core/index.ts',
        webgl: './webgl/index.ts',
        three: './three/index.ts',
        viewer: './viewer/index.ts',
        element: './viewer/element.ts',
        qtet: './tool/qtet.ts',
      },
      external: (id) => id === 'three' || id === 'uplot' || id.startsWith('node:'),
      preserveEntrySignatures: 'strict',
      output: {
        entryFileNames: '[name].js',
        chunkFileNames: 'chunks/[name]-[hash].js',
        assetFileNames: '[name][extname]',
      },
    },
  },
});
