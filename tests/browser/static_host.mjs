// Web servers that know nothing about qtet: nginx if it is installed, else a few lines of node;
// with byte ranges or without.

import {spawn, spawnSync} from 'node:child_process';
import {
  createReadStream,
  cpSync,
  existsSync,
  mkdirSync,
  rmSync,
  statSync,
  writeFileSync,
} from 'node:fs';
import {createServer} from 'node:http';
import net from 'node:net';
import {extname, join, resolve} from 'node:path';
import {setTimeout as sleep} from 'node:timers/promises';

const kNginx = '/usr/sbin/nginx';
const kTypes = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.wasm': 'application/wasm',
  '.css': 'text/css',
  '.svg': 'image/svg+xml',
  '.webp': 'image/webp',
  '.json': 'application/json',
};

/**
 * Makes a folder with the viewer's files and a log beside them, as a user would copy them to a web
 * server.
 */
export function makeSite(folder, viewer, log) {
  rmSync(folder, {recursive: true, force: true});
  mkdirSync(folder, {recursive: true});
  cpSync(viewer, folder, {recursive: true, filter: (name) => !/\.(gz|zst)$/.test(name)});
  cpSync(join(log.folder, `${log.name}.qtet`), join(folder, `${log.name}.qtet`));
  return folder;
}

/**
 * Returns {name, url, port, requests, close()}. `requests` are those that bring a file. Without
 * `ranges` the server answers every request with the whole file. With `codings` node sends NAME.br
 * for NAME, but for ranges. `headers` go with each answer of node.
 */
export async function hostFolder(
  folder,
  {ranges = true, nginx = true, codings = false, headers = {}} = {},
) {
  if (nginx && ranges && !spawnSync(kNginx, ['-v']).error) return hostByNginx(folder);
  const requests = [];
  const server = createServer((request, response) => {
    const path = join(
      folder,
      decodeURIComponent(new URL(request.url, 'http://x').pathname).replace(/\/$/, '/index.html'),
    );
    const [, from, to] = (ranges && /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? '')) || [];
    const isCoded = codings && from === undefined && existsSync(`${path}.br`);
    const file = isCoded ? `${path}.br` : path;
    const found =
      resolve(path).startsWith(resolve(folder)) && statSync(file, {throwIfNoEntry: false});
    if (!found) return void response.writeHead(404).end();
    const {size, mtimeMs} = found;
    const etag = `"${size}-${mtimeMs}"`;
    if (request.headers['if-none-match'] === etag) return void response.writeHead(304).end();
    requests.push(`${request.url} ${request.headers.range ?? ''}`);
    const type = {
      ...headers,
      ...(isCoded && {'content-encoding': 'br'}),
      etag,
      'content-type': kTypes[extname(path)] ?? 'application/octet-stream',
    };
    if (from === undefined)
      return void createReadStream(file).pipe(
        response.writeHead(200, {...type, 'content-length': size}),
      );
    if (Number(from) >= size) return void response.writeHead(416).end();
    const end = Math.min(Number(to), size - 1);
    response.writeHead(206, {
      ...type,
      'content-range': `bytes ${from}-${end}/${size}`,
      'content-length': end - from + 1,
    });
    createReadStream(path, {start: Number(from), end}).pipe(response);
  });
  await new Promise((listening) => void server.listen(0, '127.0.0.1', listening));
  return {
    name: 'node',
    url: `http://127.0.0.1:${server.address().port}/`,
    port: server.address().port,
    requests,
    close: () => server.close(),
  };
}

async function hostByNginx(folder) {
  const port = await new Promise((done) => {
    const probe = net.createServer().listen(0, '127.0.0.1', () => {
      const {port: free} = probe.address();
      probe.close(() => done(free));
    });
  });
  const state = `${folder}-nginx`;
  mkdirSync(state, {recursive: true});
  const temporary = ['client_body', 'proxy', 'fastcgi', 'uwsgi', 'scgi']
    .map((kind) => `${kind}_temp_path ${state}/${kind};`)
    .join(' ');
  writeFileSync(
    join(state, 'nginx.conf'),
    `daemon off; worker_processes 1; pid ${state}/pid; error_log ${state}/error.log;
events { worker_connections 64; }
http {
  include /etc/nginx/mime.types; access_log off; ${temporary}
  server { listen 127.0.0.1:${port}; root ${folder}; }
}
`,
  );
  const nginx = spawn(kNginx, ['-p', state, '-c', join(state, 'nginx.conf')], {stdio: 'ignore'});
  const url = `http://127.0.0.1:${port}/`;
  for (let tries = 0; tries < 100 && !(await fetch(url).catch(() => null)); ++tries)
    await sleep(50);
  return {name: 'nginx', url, port, requests: [], close: () => nginx.kill()};
}
