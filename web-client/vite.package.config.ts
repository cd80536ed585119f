// Builds the npm package's modules: QTET_WASM names the codec's WebAssembly, QTET_PACKAGE_OUT the folder to write (pack.mjs sets both).

import {defineConfig} from 'vite';

export default defineConfig({
  base: './',
  resolve: {alias: [{find: /^qtet-codec\.wasm/, replacement: process.env.QTET_WASM!}]},
  worker: {format: 'es', rollupOptions: {output: {entryFileNames: 'worker.js'}}},
  build: {
    target: 'es2022',
    outDir: process.env.QTET_PACKAGE_OUT!,
    emptyOutDir: true,
    assetsInlineLimit: 0,
    minify: false,  // the page that uses it minifies
    modulePreload: false,
    reportCompressedSize: false,
    rollupOptions: {
      input: {core: './core/index.ts', three: './three/index.ts', viewer: './viewer/index.ts', element: './viewer/element.ts'},
      external: (id) => id === 'three' || id.startsWith('three/addons/') || id === 'uplot',
      preserveEntrySignatures: 'strict',
      output: {entryFileNames: '[name].js', chunkFileNames: 'chunks/[name]-[hash].js', assetFileNames: '[name][extname]'},
    },
  },
});
