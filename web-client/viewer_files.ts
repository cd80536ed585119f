// Says in viewer.json which of the viewer's files a page in one file holds, and which ones simplify
// meshes. `qtet page` (simplify/publish/single_page.cpp), "Save page" and the wheel read it.

import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import type {Plugin} from 'vite';

/** Simplify the meshes that are dropped. Pages and the wheel do without. */
const kSimplifier = /qtet-simplify|simplify_worker|mesh_drop/;
/** A page is made of the first. The other is for slow lines. */
const kNotInPages = /^index\.html$|start_graphics/;
const kTypes: Readonly<Record<string, string>> = {
  css: 'text/css',
  js: 'text/javascript',
  svg: 'image/svg+xml',
  txt: 'text/plain',
  wasm: 'application/wasm',
};
/** Scripts, workers and WebAssembly from the page itself; no address outside of it. */
const kPolicy =
  "default-src 'none'; base-uri 'none'; script-src 'unsafe-inline' blob: 'wasm-unsafe-eval'; " +
  "style-src 'unsafe-inline'; img-src data: blob:; connect-src blob:; worker-src blob:";

export const viewerFiles = (): Plugin => ({
  name: 'viewer-files',
  apply: 'build',
  writeBundle({dir}, bundle) {
    const typed = (name: string): [string, string] => [
      name,
      kTypes[name.replace(/^.*\./, '')] ?? this.error(`viewer_files.ts has no type for ${name}`),
    ];
    const names = Object.keys(bundle).sort();
    const simplifier = names.filter((name) => kSimplifier.test(name));
    const ofPage = names.filter((name) => !kSimplifier.test(name) && !kNotInPages.test(name));
    const files = {
      policy: kPolicy,
      page: Object.fromEntries(ofPage.map(typed)),
      simplifier,
    };
    writeFileSync(join(dir!, 'viewer.json'), `${JSON.stringify(files)}\n`);
  },
});
