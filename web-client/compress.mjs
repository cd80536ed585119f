// Writes NAME.gz beside every file of the built viewer: qtet-server and nginx's gzip_static send it
// to clients that accept gzip. Prints the size of a first visit's download, and fails if it is too
// large.
//   node compress.mjs FOLDER

import {readdirSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {gzipSync} from 'node:zlib';

/**
 * Page, scripts and WebAssembly, including what is loaded on demand: one second at 2.4 Mbit/s. The
 * notices and the simplifier do not count: a visit fetches the one never and the other with the
 * first mesh that is dropped.
 */
const kMaxBytes = 300000;

const folder = process.argv[2];
const files = readdirSync(folder, {recursive: true, withFileTypes: true}).filter(
  (entry) => entry.isFile() && !entry.name.endsWith('.gz'),
);
let total = 0;
for (const file of files) {
  const path = join(file.parentPath ?? file.path, file.name);
  const compressed = gzipSync(readFileSync(path), {level: 9});
  writeFileSync(`${path}.gz`, compressed);
  if (!/^qtet-simplify|\.txt$/.test(file.name)) total += compressed.length;
  console.log(`${(compressed.length / 1000).toFixed(1).padStart(7)} kB  ${file.name}`);
}
console.log(
  `${(total / 1000).toFixed(1).padStart(7)} kB  viewer in all, gzip (at most ${kMaxBytes / 1000})`,
);
if (total > kMaxBytes) {
  console.error(
    `The viewer weighs ${total - kMaxBytes} bytes more than a first visit may download: find ` +
      'what grew, or load it on demand.',
  );
  process.exit(1);
}
