// Puts the addresses of the workers' scripts and of the base mesh's decoder into the page. The
// browser fetches them while the page's script still comes.
//
// Why not `preload`? Chromium takes a worker's script from `modulepreload` and WebAssembly from
// `prefetch`, each fetched once and without a warning. To it a worker's use of a `preload` does not
// count, and `as=worker` is unknown.

import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import type {Plugin} from 'vite';

/** The start of each name, and the link that fetches it. The most urgent one comes first. */
const kNeeded = [
  ['view_worker', 'modulepreload'], // graphics take longest to start
  ['worker', 'modulepreload'],
  ['qtet-base', 'prefetch'],
] as const;

export const preloads = (): Plugin => ({
  name: 'preloads',
  apply: 'build',
  writeBundle({dir}, bundle) {
    const path = join(dir!, 'index.html');
    const files = Object.keys(bundle);
    const links = kNeeded.map(([name, rel]) => {
      const isIt = new RegExp(`^assets/${name}-[^/]*\\.(js|wasm)$`);
      const [file, ...more] = files.filter((its) => isIt.test(its));
      if (!file || more.length > 0)
        this.error(`the build has ${file ? 'two' : 'no'} files called ${name}: adapt preloads.ts`);
      return `<link rel="${rel}" crossorigin fetchpriority="low" href="./${file}">`;
    });
    const page = readFileSync(path, 'utf8');
    // The first request takes the connection that is open, and nothing is shown without styles.
    const [style] = /<link rel="stylesheet"[^>]*>\s*/.exec(page)!;
    writeFileSync(
      path,
      page
        .replace(style, '')
        .replace('<script', `${style}<script`)
        .replace('</head>', `${links.join('\n    ')}\n  </head>`),
    );
  },
});
