// The licences of what is bundled, as a file beside the modules: they want to go where the code
// goes.

import {readFileSync} from 'node:fs';
import {fileURLToPath} from 'node:url';
import type {Plugin} from 'vite';

const kBundled = ['uplot'];

export const notices = (): Plugin => ({
  name: 'notices',
  apply: 'build',
  generateBundle() {
    const licences = kBundled.map((name) => {
      const file = fileURLToPath(new URL(`node_modules/${name}/LICENSE`, import.meta.url));
      return `${name}\n\n${readFileSync(file, 'utf8').trim()}\n`;
    });
    this.emitFile({
      type: 'asset',
      fileName: 'third-party.txt',
      source: licences.join(`\n${'-'.repeat(72)}\n\n`),
    });
  },
});
