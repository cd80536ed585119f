// Lists the viewer's files in viewer.json, so that a page can put them into one file.

import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import type {Plugin} from 'vite';

/** Files that no page with one mesh needs: what makes it, and what takes other meshes. */
const kLeftOut = /qtet-simplify|simplify_worker|mesh_drop|single_page|^first\.js$|^index\.html$/;

export const viewerFiles = (): Plugin => ({
  name: 'viewer-files',
  apply: 'build',
  writeBundle({dir}, bundle) {
    const files = Object.keys(bundle).filter((name) => !kLeftOut.test(name));
    writeFileSync(join(dir!, 'viewer.json'), `${JSON.stringify(files.sort())}\n`);
  },
});
