// The licences of what is bundled, as a file beside the modules: they want to go where the code
// goes.

import {existsSync, readFileSync} from 'node:fs';
import {fileURLToPath} from 'node:url';
import type {Plugin} from 'vite';

const kBundled = ['uplot'];
/** Packages that are compiled into the WebAssembly. Debian states their licences. */
const kCompiled = [
  'libc++-19-dev-wasm32',
  'wasi-libc',
  'libdraco-dev',
  'libexpat1-dev',
  'libdeflate-dev',
  'liblz4-dev',
  'liblzma-dev',
  'libfast-float-dev',
  'nlohmann-json3-dev',
  'libboost-dev',
];

export const notices = (): Plugin => ({
  name: 'notices',
  apply: 'build',
  generateBundle() {
    const files = [
      ...kBundled.map((name) => [
        name,
        fileURLToPath(new URL(`node_modules/${name}/LICENSE`, import.meta.url)),
      ]),
      ...kCompiled
        .map((name) => [name, `/usr/share/doc/${name}/copyright`])
        .filter(([, file]) => existsSync(file!)),
    ];
    const licences = files.map(
      ([name, file]) => `${name}\n\n${readFileSync(file!, 'utf8').trim()}\n`,
    );
    this.emitFile({
      type: 'asset',
      fileName: 'third-party.txt',
      source: licences.join(`\n${'-'.repeat(72)}\n\n`),
    });
  },
});
