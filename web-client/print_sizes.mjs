// Prints what a first visit downloads: every file of the built viewer, compressed as a web server would.
// Usage: node print_sizes.mjs FOLDER

import {readdirSync, readFileSync} from 'node:fs';
import {join} from 'node:path';
import {gzipSync} from 'node:zlib';

const folder = process.argv[2];
const files = readdirSync(folder, {recursive: true, withFileTypes: true}).filter((entry) => entry.isFile());
let total = 0;
for (const file of files) {
  const path = join(file.parentPath ?? file.path, file.name);
  const size = gzipSync(readFileSync(path), {level: 9}).length;
  total += size;
  console.log(`${String(Math.round(size / 1000)).padStart(6)} kB  ${file.name}`);
}
console.log(`${String(Math.round(total / 1000)).padStart(6)} kB  viewer in all, gzip`);
