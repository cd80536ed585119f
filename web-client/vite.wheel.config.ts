// Builds what the Python wheel without a native library carries, to QTET_WHEEL_OUT: the command for
// node (--mode node), and the script that Pyodide evaluates (--mode pyodide).

import {defineConfig} from 'vite';
import {notices} from './notices';

export default defineConfig(({mode}) => ({
  publicDir: false,
  plugins: [notices(true)],
  build: {
    target: 'es2022',
    outDir: process.env.QTET_WHEEL_OUT!,
    emptyOutDir: false,
    minify: false,
    reportCompressedSize: false,
    rollupOptions: {
      input: mode === 'node' ? './tool/qtet.ts' : './tool/pyodide_host.ts',
      external: (id) => id.startsWith('node:'),
      preserveEntrySignatures: 'strict',
      output: {
        format: mode === 'node' ? 'es' : 'iife',
        name: 'qtetTool',
        entryFileNames: mode === 'node' ? 'qtet.mjs' : 'tool.js',
        assetFileNames: '[name][extname]',
      },
    },
  },
}));
