// Builds the npm package's modules: QTET_WASM names the codec's WebAssembly, QTET_PACKAGE_OUT the
// folder to write (pack.mjs sets both).

import {defineConfig, type Plugin, transformWithEsbuild} from 'vite';
import {notices} from './notices';
import {smallShaders} from './small_shaders';

/**
 * Vite would wrap import() in its own preloading. The Vite of a page that uses the package then
 * takes it for its own and calls it without an address.
 */
const plainDynamicImports: Plugin = {
  name: 'plain-dynamic-imports',
  configResolved({plugins}) {
    const at = plugins.findIndex(({name}) => name === 'vite:build-import-analysis');
    if (at < 0)
      throw new Error(
        'vite:build-import-analysis has another name: see that no chunk of the package holds ' +
          '__vitePreload',
      );
    (plugins as Plugin[]).splice(at, 1);
  },
};

export default defineConfig({
  base: './',
  publicDir: false, // it is the page's
  plugins: [plainDynamicImports, notices()],
  resolve: {alias: [{find: /^qtet-codec\.wasm/, replacement: process.env.QTET_WASM!}]},
  // Bundlers copy workers' files unchanged. So these contain everything they need, including three,
  // and are minified here.
  worker: {
    format: 'es',
    rollupOptions: {output: {entryFileNames: '[name].js'}},
    plugins: () => [
      ...smallShaders(),
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
        three: './three/index.ts',
        viewer: './viewer/index.ts',
        element: './viewer/element.ts',
      },
      external: (id) => id === 'three' || id.startsWith('three/addons/') || id === 'uplot',
      preserveEntrySignatures: 'strict',
      output: {
        entryFileNames: '[name].js',
        chunkFileNames: 'chunks/[name]-[hash].js',
        assetFileNames: '[name][extname]',
      },
    },
  },
});
