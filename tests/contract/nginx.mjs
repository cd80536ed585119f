// server/deploy/nginx.conf in front of a qtet-server: HTTP/2, ranges, an upload, the WebSocket's
// handshake, and no way to the operators' paths.
//   node nginx.mjs --bin build/release/bin --out FOLDER
// Exit code 77: nginx or openssl is not installed.

import assert from 'node:assert';
import {spawnSync} from 'node:child_process';
import {mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import http2 from 'node:http2';
import https from 'node:https';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';
import {kToken, prepare, startNginx, startServer} from './server.mjs';

const {values: options} = parseArgs({options: {bin: {type: 'string'}, out: {type: 'string'}}});
const kNginx = '/usr/sbin/nginx';
for (const program of [kNginx, 'openssl'])
  if (spawnSync(program, [program === kNginx ? '-v' : 'version']).error) process.exit(77);

/**
 * The example with this machine's ports and a certificate of its own; everything else as it stands.
 */
function configure(folder, serverPort, port) {
  const made = spawnSync(
    'openssl',
    [
      'req',
      '-x509',
      '-newkey',
      'ec',
      '-pkeyopt',
      'ec_paramgen_curve:P-256',
      '-nodes',
      '-days',
      '1',
      '-subj',
      '/CN=localhost',
      '-keyout',
      join(folder, 'key.pem'),
      '-out',
      join(folder, 'cert.pem'),
    ],
    {encoding: 'utf8'},
  );
  assert.equal(made.status, 0, made.stderr);
  const example = readFileSync(
    fileURLToPath(new URL('../../server/deploy/nginx.conf', import.meta.url)),
    'utf8',
  )
    .replace('server 127.0.0.1:8080;', `server 127.0.0.1:${serverPort};`)
    .replace('listen 443 ssl', `listen 127.0.0.1:${port} ssl`)
    .replace(/ssl_certificate_key .*/, `ssl_certificate_key ${folder}/key.pem;`)
    .replace(/ssl_certificate {2}.*/, `ssl_certificate ${folder}/cert.pem;`);
  writeFileSync(
    join(folder, 'nginx.conf'),
    `daemon off; worker_processes 1; pid ${folder}/pid; error_log ${folder}/error.log;
events { worker_connections 256; }
http { access_log off;
client_body_temp_path ${folder}/body; proxy_temp_path ${folder}/proxy;
fastcgi_temp_path ${folder}/f; uwsgi_temp_path ${folder}/u; scgi_temp_path ${folder}/s;
${example}}
`,
  );
}

function ask(port, method, path, headers = {}, body = undefined) {
  return new Promise((done, failed) => {
    const request = https.request(
      {port, method, path, headers, rejectUnauthorized: false, agent: false},
      (response) => {
        const pieces = [];
        response.on('data', (piece) => pieces.push(piece));
        response.on('end', () =>
          done({
            status: response.statusCode,
            headers: response.headers,
            body: Buffer.concat(pieces),
          }),
        );
      },
    );
    request.on(
      'upgrade',
      (response, socket) => (
        socket.destroy(),
        done({status: response.statusCode, headers: response.headers})
      ),
    );
    request.on('error', failed);
    request.end(body);
  });
}

function askHttp2(port, path) {
  return new Promise((done, failed) => {
    const client = http2
      .connect(`https://127.0.0.1:${port}`, {rejectUnauthorized: false})
      .on('error', failed);
    const stream = client.request({':path': path});
    stream.on('response', (headers) => (client.destroy(), done(headers[':status'])));
    stream.on('error', failed);
  });
}

async function check(port) {
  const mesh = JSON.parse((await ask(port, 'GET', '/v1/meshes/fin')).body);
  const log = readFileSync(join(options.out, 'logs/fin.qtet'));
  const whole = await ask(port, 'GET', mesh.links.log);
  assert.ok(whole.body.equals(log), 'the log is another one behind nginx');
  const part = await ask(port, 'GET', mesh.links.log, {range: 'bytes=10-19'});
  assert.equal(part.status, 206);
  assert.ok(part.body.equals(log.subarray(10, 20)));
  assert.match(part.headers['x-request-id'], /^[0-9a-f]{32}$/, "nginx's own request id comes back");
  assert.equal(
    (await ask(port, 'GET', mesh.links.log, {'if-none-match': whole.headers.etag})).status,
    304,
  );
  assert.equal(await askHttp2(port, '/v1/meshes'), 200);
  for (const path of ['/metrics', '/livez', '/readyz', '/version'])
    assert.equal((await ask(port, 'GET', path)).status, 404, path);
  const other = readFileSync(join(options.out, 'other.qtet'));
  assert.equal(
    (await ask(port, 'PUT', '/v1/meshes/up', {authorization: `Bearer ${kToken}`}, other)).status,
    201,
  );
  const handshake = await ask(port, 'GET', '/v1/stream', {
    connection: 'Upgrade',
    upgrade: 'websocket',
    'sec-websocket-version': '13',
    'sec-websocket-key': 'dGhlIHNhbXBsZSBub25jZQ==',
    'sec-websocket-protocol': 'qtet.v1',
  });
  assert.equal(handshake.status, 101);
  assert.equal(handshake.headers['sec-websocket-protocol'], 'qtet.v1');
}

prepare(options);
const server = await startServer(options);
const folder = join(options.out, 'nginx');
mkdirSync(folder, {recursive: true});
const nginx = await startNginx(kNginx, folder, (port) => configure(folder, server.port, port));
try {
  await check(nginx.port);
  console.log('nginx.conf: HTTP/2, ranges, conditions, an upload and the WebSocket work behind it');
} finally {
  server.child.removeAllListeners('exit');
  nginx.child.kill('SIGTERM');
  server.child.kill('SIGTERM');
}
