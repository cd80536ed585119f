// Puts NAME.gz beside every file of the built viewer, which qtet-server (and nginx's gzip_static) sends to whoever takes it, and prints what a
// first visit downloads. Usage: node compress.mjs FOLDER

import {readdirSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {gzipSync} from 'node:zlib';

const folder = process.argv[2];
const files = readdirSync(folder, {recursive: true, withFileTypes: true}).filter((entry) => entry.isFile() && !entry.name.endsWith('.gz'));
let total = 0;
for (const file of files) {
  const path = join(file.parentPath ?? file.path, file.name);
  const compressed = gzipSync(readFileSync(path), {level: 9});
  writeFileSync(`${path}.gz`, compressed);
  total += compressed.length;
  console.log(`${String(Math.round(compressed.length / 1000)).padStart(6)} kB  ${file.name}`);
}
console.log(`${String(Math.round(total / 1000)).padStart(6)} kB  viewer in all, gzip`);
