// Puts start_graphics.ts into the page, behind the main script. It preloads the workers a round
// trip later: on a line whose bytes all files share they would make the main script late. The base
// mesh's decoder is the largest file. The worker that decodes asks for it while a connection for
// the mesh opens.
//
// Why not `preload`? Chromium takes a worker's script from `modulepreload`, fetched once and
// without a warning. To it a worker's use of a `preload` does not count, and `as=worker` is
// unknown.

import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {build, type Plugin, type Rollup} from 'vite';

const kStart = 'viewer/start_graphics.ts';

/** The script as one file: a chunk would share modules with the main script. */
async function startScript(): Promise<string> {
  const built = await build({
    configFile: false,
    logLevel: 'warn',
    build: {
      write: false,
      target: 'es2022',
      minify: 'esbuild',
      lib: {entry: kStart, formats: ['es']},
    },
  });
  const [{output}] = built as [Rollup.RollupOutput];
  return output[0].code;
}

export const preloads = (): Plugin => ({
  name: 'preloads',
  apply: 'build',
  async generateBundle() {
    this.emitFile({type: 'asset', name: 'start_graphics.js', source: await startScript()});
  },
  writeBundle({dir}, bundle) {
    const path = join(dir!, 'index.html');
    const named = (start: string): string => {
      const [file, ...more] = Object.keys(bundle).filter((name) => name.startsWith(start));
      if (!file || more.length > 0)
        this.error(`the build has ${file ? 'two' : 'no'} files ${start}: adapt preloads.ts`);
      return file;
    };
    const start = named('assets/start_graphics-');
    const script =
      `<script type="module" async crossorigin src="./${start}" ` +
      `data-workers="./${named('assets/view_worker-')} ./${named('assets/worker-')}"></script>`;
    const page = readFileSync(path, 'utf8');
    // The first request takes the connection that is open, and nothing is shown without styles.
    const [style] = /<link rel="stylesheet"[^>]*>\s*/.exec(page)!;
    writeFileSync(
      path,
      page
        .replace(style, '')
        .replace('<script', `${style}<script`)
        .replace('</head>', `  ${script}\n  </head>`),
    );
  },
});
