// Writes NAME.gz and NAME.zst beside every file of the built viewer, but no NAME.zst where that
// would be no smaller. qtet-server sends them to clients that accept gzip or zstd, after it has
// compared them with NAME; nginx's gzip_static sends the first. Without the program zstd the server
// compresses by itself, less. Prints the size of a first visit's download, and fails if it is too
// large.
//   node compress.mjs FOLDER

import {spawnSync} from 'node:child_process';
import {readdirSync, readFileSync, rmSync, statSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {gzipSync} from 'node:zlib';

/**
 * Page, scripts and WebAssembly, including what is loaded on demand: one second at 2.8 Mbit/s. Own
 * fields, numbers about what is drawn, parts, arrows, streamlines and kept points took it from 300
 * to 354 kB. They are loaded on use. The notices and the simplifier do not count: a visit fetches
 * the one never and the other with the first mesh that is dropped.
 */
const kMaxBytes = 354000;

const folder = process.argv[2];
const files = readdirSync(folder, {recursive: true, withFileTypes: true}).filter(
  (entry) => entry.isFile() && !/\.(gz|zst)$/.test(entry.name),
);
const paths = files.map((file) => join(file.parentPath ?? file.path, file.name));
/** Above it windows grow beyond what browsers take. */
const kZstdLevel = 19;
const zstd = spawnSync('zstd', [`-${kZstdLevel}`, '-q', '-f', '--no-check', ...paths], {
  stdio: ['ignore', 'inherit', 'inherit'],
});
if (zstd.error) console.log('There is no program zstd: no NAME.zst.');
else if (zstd.status !== 0) process.exit(1);
else
  for (const path of paths)
    if (statSync(`${path}.zst`).size >= statSync(path).size) rmSync(`${path}.zst`);

let total = 0;
for (const [i, file] of files.entries()) {
  const path = paths[i];
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
