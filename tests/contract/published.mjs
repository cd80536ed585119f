// A folder that `qtet publish` made, served by nginx with the lines of the folder's own README.txt:
// compression, types, caching, CORS and ranges.
//   node published.mjs --bin build/release/bin --out FOLDER
// QTET_NGINX names an nginx that is not installed. Exit code 77: there is none.

import assert from 'node:assert/strict';
import {execFileSync, spawnSync} from 'node:child_process';
import {mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import http from 'node:http';
import {join} from 'node:path';
import {parseArgs} from 'node:util';
import {gunzipSync} from 'node:zlib';
import {startNginx} from './server.mjs';

const {values: options} = parseArgs({options: {bin: {type: 'string'}, out: {type: 'string'}}});
const kNginx = process.env.QTET_NGINX ?? '/usr/sbin/nginx';
if (spawnSync(kNginx, ['-v']).error) {
  console.log('skipped: nginx is not installed (Debian: nginx-light)');
  process.exit(77);
}

const kTypes = `types { text/html html; text/javascript js; application/wasm wasm;
  application/json json; text/plain txt; } default_type application/octet-stream;`;

/** The lines of README.txt below "nginx:", with this test's port and folder. */
function serverBlock(site, port) {
  const notes = readFileSync(join(site, 'README.txt'), 'utf8');
  const [, block] = /^nginx:\n((?: {4}.*\n)+)/m.exec(notes);
  return block.replace('listen 80;', `listen 127.0.0.1:${port};`).replace('/var/www/meshes', site);
}

async function serve(site, state) {
  mkdirSync(state, {recursive: true});
  const temporary = ['client_body', 'proxy', 'fastcgi', 'uwsgi', 'scgi']
    .map((kind) => `${kind}_temp_path ${state}/${kind};`)
    .join(' ');
  const configure = (port) =>
    writeFileSync(
      join(state, 'nginx.conf'),
      `user root; daemon off; worker_processes 1; pid ${state}/pid; error_log ${state}/error.log;
events { worker_connections 64; }
http { ${kTypes} access_log off; ${temporary}
${serverBlock(site, port)}}
`,
    );
  const {child, port} = await startNginx(kNginx, state, configure);
  return {port, close: () => child.kill()};
}

function ask(port, path, headers = {}) {
  return new Promise((done, failed) => {
    http
      .get({port, host: '127.0.0.1', path, headers, agent: false}, (response) => {
        const pieces = [];
        response.on('data', (piece) => pieces.push(piece));
        response.on('end', () =>
          done({
            status: response.statusCode,
            headers: response.headers,
            body: Buffer.concat(pieces),
          }),
        );
      })
      .on('error', failed);
  });
}

async function check(port, site) {
  const scripts = readdirSync(join(site, 'assets')).filter((name) => name.endsWith('.js'));
  const script = `/assets/${scripts[0]}`;
  const small = await ask(port, script, {'accept-encoding': 'gzip'});
  assert.equal(small.headers['content-encoding'], 'gzip');
  assert.ok(gunzipSync(small.body).equals(readFileSync(join(site, script))));
  assert.match(small.headers['content-type'], /javascript/);
  assert.match(small.headers['cache-control'], /immutable/);
  assert.match(small.headers.vary, /Accept-Encoding/);
  const plain = await ask(port, script);
  assert.equal(plain.headers['content-encoding'], undefined);

  const [mesh] = JSON.parse((await ask(port, '/index.json')).body).meshes;
  const log = readFileSync(join(site, 'box.qtet'));
  const part = await ask(port, `/${mesh.links.log}`, {
    range: 'bytes=10-19',
    'accept-encoding': 'gzip',
  });
  assert.equal(part.status, 206);
  assert.ok(part.body.equals(log.subarray(10, 20)));
  assert.equal(part.headers['content-range'], `bytes 10-19/${mesh.bytes}`);
  assert.equal(part.headers['content-encoding'], undefined);
  for (const path of ['/', '/index.json', '/box.qtet']) {
    const {headers} = await ask(port, path);
    assert.equal(headers['cache-control'], 'no-cache', path);
    assert.equal(headers['access-control-allow-origin'], '*', path);
    assert.match(headers['access-control-expose-headers'], /Content-Range/, path);
    assert.equal((await ask(port, path, {'if-none-match': headers.etag})).status, 304, path);
  }
}

rmSync(options.out, {recursive: true, force: true});
mkdirSync(options.out, {recursive: true});
const qtet = (...words) =>
  execFileSync(join(options.bin, 'qtet'), words, {cwd: options.out, stdio: 'pipe'});
qtet('sample', 'box', '-o', 'box.vtu');
qtet('simplify', 'box.vtu', '-o', 'box.qtet');
qtet('publish', 'site', 'box.qtet');
const site = join(options.out, 'site');
const server = await serve(site, join(options.out, 'nginx'));
try {
  await check(server.port, site);
} finally {
  server.close();
}
console.log('published: nginx serves the folder as its README.txt says');
