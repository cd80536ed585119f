// The licences of what is bundled, as files beside the modules: they want to go where the code
// goes.

import {existsSync, readFileSync} from 'node:fs';
import {fileURLToPath} from 'node:url';
import type {Plugin} from 'vite';

const kBundled = ['uplot'];
/** Debian's packages in all WebAssembly, and those in the simplifier beside them. */
const kCompiled = ['libc++-19-dev-wasm32', 'wasi-libc'];
const kSimplifier = [
  'libdraco-dev',
  'libexpat1-dev',
  'libdeflate-dev',
  'liblz4-dev',
  'liblzma-dev',
  'libmetis-dev',
  'libfast-float-dev',
  'nlohmann-json3-dev',
  'libboost-dev',
];

const kTool = [...kSimplifier, 'libboost-program-options-dev', 'libwebp-dev', 'zlib1g-dev'];

const ofPackage = (name: string): string =>
  fileURLToPath(new URL(`node_modules/${name}/LICENSE`, import.meta.url));
const ofDebian = (name: string): string => `/usr/share/doc/${name}/copyright`;

/** The texts one behind the other; on other systems than Debian some are missing. */
const joined = (files: [name: string, path: string][]): string =>
  files
    .filter(([, path]) => existsSync(path))
    .map(([name, path]) => `${name}\n\n${readFileSync(path, 'utf8').trim()}\n`)
    .join(`\n${'-'.repeat(72)}\n\n`);

/** `withTool`: the command of the npm package is there, too. */
export const notices = (withTool = false): Plugin => ({
  name: 'notices',
  apply: 'build',
  generateBundle() {
    const texts: Record<string, string> = {
      'third-party.txt': joined([
        ...kBundled.map((name): [string, string] => [name, ofPackage(name)]),
        ...kCompiled.map((name): [string, string] => [name, ofDebian(name)]),
      ]),
      'qtet-simplify.third-party.txt': joined(
        kSimplifier.map((name): [string, string] => [name, ofDebian(name)]),
      ),
    };
    if (withTool)
      texts['qtet-tool.third-party.txt'] = joined(
        kTool.map((name): [string, string] => [name, ofDebian(name)]),
      );
    for (const [fileName, source] of Object.entries(texts))
      this.emitFile({type: 'asset', fileName, source});
  },
});
