// Every response of a running qtet-server against proto/openapi.yaml.
//   node check.mjs --bin build/release/bin --out FOLDER      empties FOLDER first
// Asks for everything that the description names and validates status, type, headers and JSON.
// Fails if an answer that the description names was never seen.

import {spawnSync} from 'node:child_process';
import {createHash} from 'node:crypto';
import {readFileSync} from 'node:fs';
import http from 'node:http';
import {join} from 'node:path';
import {parseArgs} from 'node:util';
import Ajv2020 from 'ajv/dist/2020.js';
import addFormats from 'ajv-formats';
import validator from 'gltf-validator';
import {parse} from 'yaml';
import {kToken, prepare, startServer} from './server.mjs';

const {values: options} = parseArgs({options: {bin: {type: 'string'}, out: {type: 'string'}}});
const source = join(import.meta.dirname ?? new URL('.', import.meta.url).pathname, '../..');
const description = parse(readFileSync(join(source, 'proto/openapi.yaml'), 'utf8'), {
  maxAliasCount: -1,
});
/** Answers that no request gets from a healthy server. */
const kUnasked = new Set([
  'readLevel 500',
  'readLevel 503',
  'readSeries 500',
  'readSeries 503',
  'readPoster 500',
  'readPoster 503',
  'putMesh 503',
  'putMesh 507',
  'isReady 503',
  'openStream 101',
  'readViewer 404',
]);

const kForms = ['vtu', 'vtk', 'msh', 'usda', 'glb', 'drc', 'obj'];

const complaints = [];
const seen = new Set();
const complain = (what, why) => complaints.push(`${what}: ${why}`);

// ---- the description

const ajv = new Ajv2020({strict: false, allErrors: true});
addFormats(ajv);
ajv.addSchema(description, 'openapi');
const pointerOf = (parts) =>
  'openapi#/' +
  parts
    .map((part) => encodeURIComponent(String(part).replaceAll('~', '~0').replaceAll('/', '~1')))
    .join('/');
const validatorAt = (parts) =>
  ajv.getSchema(pointerOf(parts)) ?? ajv.compile({$ref: pointerOf(parts)});
/** The object at `parts`, references followed, and where it stands. */
function resolve(parts) {
  const object = parts.reduce((at, part) => at?.[part], description);
  return object?.$ref
    ? resolve(
        object.$ref
          .slice(2)
          .split('/')
          .map((part) => part.replaceAll('~1', '/').replaceAll('~0', '~')),
      )
    : {object, parts};
}
const patterns = Object.keys(description.paths).map((template) => {
  const escaped = template
    .replace(/[.*+?^$()|[\]\\]/g, '\\$&')
    .replaceAll('{rest}', '.+')
    .replaceAll('{level}', '[^/.]+')
    .replaceAll('{form}', `(?:${kForms.join('|')})`);
  return {template, pattern: new RegExp('^' + escaped.replace(/\{[^}]+\}/g, '[^/]+') + '$')};
});
/** The most exact template: the one with the fewest braces. */
const templateOf = (path) =>
  patterns
    .filter(({pattern}) => pattern.test(path))
    .sort(
      (a, b) =>
        a.template.split('{').length - b.template.split('{').length ||
        b.template.length - a.template.length,
    )[0]?.template;

function judge(what, method, path, reply) {
  for (const header of ['date', 'access-control-allow-origin', 'access-control-expose-headers'])
    if (!reply.headers[header]) complain(what, `has no ${header}`);
  if (reply.headers['content-type'] && !reply.headers['x-content-type-options'])
    complain(what, 'has no x-content-type-options');
  const template = templateOf(path);
  const isProblem = reply.status >= 400;
  if (isProblem && reply.headers['content-type'] !== 'application/problem+json')
    complain(what, `an error as ${reply.headers['content-type']}`);
  if (method === 'OPTIONS') return;
  const operation =
    template && description.paths[template][method === 'HEAD' ? 'get' : method.toLowerCase()];
  if (!operation) {
    if (!isProblem) complain(what, 'is not described');
    return judgeBody(what, method, reply, ['components', 'responses', 'Problem']);
  }
  const status = operation.responses[reply.status] ? String(reply.status) : 'default';
  if (status === 'default' && !isProblem) complain(what, `status ${reply.status} is not described`);
  seen.add(`${operation.operationId} ${status}`);
  judgeBody(what, method, reply, [
    'paths',
    template,
    method === 'HEAD' ? 'get' : method.toLowerCase(),
    'responses',
    status,
  ]);
}

function judgeBody(what, method, reply, place) {
  const {object: response, parts} = resolve(place);
  for (const name of Object.keys(response.headers ?? {})) {
    const header = resolve([...parts, 'headers', name]);
    const value = reply.headers[name.toLowerCase()];
    if (value === undefined) complain(what, `lacks the header ${name}`);
    else if (!validatorAt([...header.parts, 'schema'])(value)) complain(what, `${name}: ${value}`);
  }
  if (!response.content) {
    if (reply.body.length > 0) complain(what, 'has a body that is not described');
    return;
  }
  const type = (reply.headers['content-type'] ?? '').split(';')[0];
  if (!response.content[type]) return complain(what, `type ${type} is not described`);
  if (method === 'HEAD' || !response.content[type].schema || reply.headers['content-encoding'])
    return;
  const body = type.endsWith('json') ? JSON.parse(reply.body.toString()) : reply.body.toString();
  const validate = validatorAt([...parts, 'content', type, 'schema']);
  if (!validate(body)) complain(what, ajv.errorsText(validate.errors));
  if (type === 'application/problem+json' && body.status !== reply.status)
    complain(what, 'the problem has another status');
}

// ---- the questions

const agent = new http.Agent({keepAlive: true, maxSockets: 1});
function ask(port, method, path, headers = {}, body = undefined) {
  return new Promise((done, failed) => {
    const request = http.request(
      {
        port,
        method,
        path,
        headers: body === undefined ? headers : {'content-length': body.length, ...headers},
        agent,
      },
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
    // else node adds a Transfer-Encoding where there is no length
    request.useChunkedEncodingByDefault = false;
    request.on('error', failed);
    request.end(body);
  });
}

/** Asks the server at `port`, and compares the answer with the description. */
const expectsOf = (port) => async (status, method, path, headers, body) => {
  const reply = await ask(port, method, path, headers, body);
  const what = `${method} ${path} ${headers ? JSON.stringify(headers).slice(0, 200) : ''}`;
  if (reply.status !== status)
    complain(
      what,
      `status ${reply.status} instead of ${status}: ${reply.body.toString().slice(0, 200)}`,
    );
  judge(what, method, path.split('?')[0], reply);
  return reply;
};

async function checkAll(port) {
  const expect = expectsOf(port);
  const get = (status, path, headers) => expect(status, 'GET', path, headers);
  const mesh = JSON.parse((await get(200, '/v1/meshes/fin')).body);
  const log = `/v1/logs/${mesh.digest}`;

  const documents = ['/v1/meshes', '/v1/meshes/fin', `${log}/manifest`, '/openapi.json', '/'];
  const binaries = [
    `${log}/log`,
    `${log}/base`,
    `${log}/chunks/0`,
    `${log}/fields/Density/chunks/0`,
  ];
  const levels = kForms.map((form) => `${log}/levels/1.${form}`).concat(`${log}/poster.webp`);
  const place = `${log}/series?x=0.5&y=0.5&z=0.5&field=Velocity`;
  const series = [place, `${place}&format=csv`];
  for (const path of [...documents, ...binaries, ...levels, ...series]) {
    const whole = await get(200, path);
    await expect(200, 'HEAD', path);
    await expect(204, 'OPTIONS', path);
    await get(304, path, {'if-none-match': whole.headers.etag});
    await get(412, path, {'if-match': '"other"'});
    if (documents.includes(path)) continue;
    const part = await get(206, path, {range: 'bytes=1-3'});
    if (!part.body.equals(whole.body.subarray(1, 4)))
      complain(path, 'the range is not that of the whole');
    await get(416, path, {range: `bytes=${whole.body.length}-`});
  }
  for (const form of kForms) {
    // as the tool writes them
    const file = join(options.out, `level.${form}`);
    const done = spawnSync(
      join(options.bin, 'qtet'),
      ['extract', join(options.out, 'logs/fin.qtet'), '--level', '1', '-o', file],
      {encoding: 'utf8'},
    );
    if (
      done.status !== 0 ||
      !(await get(200, `${log}/levels/1.${form}`)).body.equals(readFileSync(file))
    )
      complain(form, `is not what the tool writes ${done.stderr}`);
  }
  const glb = await get(200, `${log}/levels/fit.glb?error=Density:0.02`);
  const verdict = await validator.validateBytes(new Uint8Array(glb.body), {
    ignoredIssues: ['UNSUPPORTED_EXTENSION'],
  });
  if (verdict.issues.numErrors > 0) complain('glb', JSON.stringify(verdict.issues.messages));
  await get(200, `${log}/levels/fit.vtu?tets=500&fields=Density`, {'accept-encoding': 'zstd'});
  const served = JSON.parse((await get(200, '/openapi.json')).body);
  if (JSON.stringify(sorted(served)) !== JSON.stringify(sorted(description)))
    complain(
      '/openapi.json',
      'is not proto/openapi.yaml; make proto/openapi.json anew with: node ' +
        'tests/contract/openapi_json.mjs',
    );

  const nobody = '0'.repeat(64);
  for (const path of [
    '/v1/meshes/none',
    '/v1/meshes/none/log',
    `/v1/logs/${nobody}/log`,
    `/v1/logs/${nobody}/manifest`,
    `/v1/logs/${nobody}/base`,
    `/v1/logs/${nobody}/poster.webp`,
    `${log}/chunks/99999`,
    `${log}/fields/none/chunks/0`,
    `${log}/levels/999.vtu`,
    `${log}/levels/fit.vtu?error=none:1`,
    `${log}/levels/1.vtu?time=0`,
    place.replace('Velocity', 'none'),
    place.replace('x=0.5', 'x=1e9'),
    `${place}&level=9999`,
    '/nothing',
    '/v2',
  ])
    await get(404, path);
  for (const path of [
    '/v1/meshes?limit=0',
    `${log}/levels/fit.vtu`,
    `${log}/levels/1.vtu?time=all`,
    `${log}/series`,
    `${place}&level=1&error=0.1`,
    place.replace('x=0.5', 'x=nan'),
    '/%',
    '/v1/stream/%zz',
  ])
    await get(400, path);
  await get(307, '/v1/meshes/fin/log');
  await get(426, '/v1/stream');
  await get(400, '/v1/stream', {
    connection: 'Upgrade',
    upgrade: 'websocket',
    'sec-websocket-version': '13',
    'sec-websocket-key': 'dGhlIHNhbXBsZSBub25jZQ==',
  });
  for (const path of ['/livez', '/readyz', '/metrics', '/version']) await get(200, path);
  for (const method of ['POST', 'PATCH', 'DELETE']) await expect(405, method, '/v1/meshes');
  await get(431, '/', {x: 'y'.repeat(8500), z: 'y'.repeat(8500)});
  await get(431, '/', Object.fromEntries(Array.from({length: 100}, (_, i) => [`x-${i}`, '1'])));
  await get(417, '/', {expect: 'wonders'});
  await checkWriting(expect, mesh);
  await checkReading(expect);
}

async function checkReading(expect) {
  const token = {authorization: `Bearer ${kToken}`};
  const nobody = {authorization: 'Bearer of-whom-nobody-has-heard'};
  await expect(401, 'GET', '/v1/meshes/secret');
  await expect(403, 'GET', '/v1/meshes/secret', token);
  await expect(401, 'GET', '/v1/meshes', nobody);
  await expect(200, 'GET', '/v1/meshes', token);
  await expect(401, 'POST', '/v1/tickets', {'content-length': 0});
  await expect(201, 'POST', '/v1/tickets', {'content-length': 0, ...token});
  await expect(405, 'GET', '/v1/tickets', token);
  await expect(405, 'PUT', '/v1/tickets', token);
  await expect(204, 'OPTIONS', '/v1/tickets');
  for (let i = 1; i < 256; ++i) await expect(201, 'POST', '/v1/tickets', token);
  await expect(429, 'POST', '/v1/tickets', token);
  const handshake = {
    connection: 'Upgrade',
    upgrade: 'websocket',
    'sec-websocket-version': '13',
    'sec-websocket-key': 'dGhlIHNhbXBsZSBub25jZQ==',
    'sec-websocket-protocol': 'qtet.v1',
  };
  await expect(401, 'GET', '/v1/stream?ticket=none', handshake);
}

async function checkWriting(expect, mesh) {
  const token = {authorization: `Bearer ${kToken}`};
  const other = readFileSync(join(options.out, 'other.qtet'));
  const digest = createHash('sha256').update(other).digest('hex');
  const put = (status, path, headers, body = other) => expect(status, 'PUT', path, headers, body);
  const half = Math.floor(other.length / 2);
  const range = (first, last) => ({
    ...token,
    'content-range': `bytes ${first}-${last}/${other.length}`,
  });
  await put(401, '/v1/meshes/up');
  await put(403, '/v1/meshes/fin', token);
  await put(404, '/v1/meshes/up%2f', token);
  await put(415, '/v1/meshes/up', {...token, 'content-encoding': 'gzip'});
  await put(413, '/v1/meshes/up', token, Buffer.alloc(1000001));
  await put(422, '/v1/meshes/up', token, Buffer.from('nonsense'));
  await put(
    422,
    '/v1/meshes/up',
    token,
    readFileSync(new URL('../golden/must-fail/bad-value.structure-of-noise.qtet', import.meta.url)),
  );
  // a level that its kind of file cannot hold
  await put(201, '/v1/meshes/up-long', token, readFileSync(join(options.out, 'long.qtet')));
  const long = JSON.parse((await expect(200, 'GET', '/v1/meshes/up-long')).body);
  await expect(422, 'GET', `/v1/logs/${long.digest}/levels/0.msh`);
  await put(412, '/v1/meshes/up', {...token, 'if-match': '*'});
  await put(400, '/v1/meshes/up?digest=1', token);
  await put(202, `/v1/meshes/up?digest=${digest}`, range(0, half - 1), other.subarray(0, half));
  await put(409, `/v1/meshes/up?digest=${digest}`, range(1, half), other.subarray(1, half + 1));
  const partial = `/v1/meshes/up/upload?digest=${digest}`;
  await expect(200, 'GET', partial, token);
  await expect(401, 'GET', partial);
  await expect(403, 'GET', partial.replace('/up/', '/fin/'), token);
  await expect(400, 'GET', '/v1/meshes/up/upload', token);
  await put(
    201,
    `/v1/meshes/up?digest=${digest}`,
    range(half, other.length - 1),
    other.subarray(half),
  );
  await expect(404, 'GET', partial, token);
  await put(
    409,
    `/v1/meshes/up?digest=${digest}`,
    {...token, 'content-range': `bytes */${other.length}`},
    Buffer.alloc(0),
  );
  await put(200, '/v1/meshes/up', token);
  await expect(411, 'PUT', '/v1/meshes/up', token);
  await expect(412, 'DELETE', '/v1/meshes/up', {...token, 'if-match': `"${mesh.digest}"`});
  await expect(401, 'DELETE', '/v1/meshes/up');
  await expect(403, 'DELETE', '/v1/meshes/fin', token);
  await expect(405, 'POST', '/v1/meshes/up');
  await expect(204, 'DELETE', '/v1/meshes/up', token);
  await expect(404, 'DELETE', '/v1/meshes/up', token);
}

/** With members in the order of their names: for comparing. */
const sorted = (value) =>
  Array.isArray(value)
    ? value.map(sorted)
    : value && typeof value === 'object'
      ? Object.fromEntries(
          Object.keys(value)
            .sort()
            .map((key) => [key, sorted(value[key])]),
        )
      : value;

/** A server that has no memory for levels. */
async function checkTooLarge(port) {
  const expect = expectsOf(port);
  const {digest} = JSON.parse((await expect(200, 'GET', '/v1/meshes/fin')).body);
  const series = 'series?x=0.5&y=0.5&z=0.5&field=Velocity';
  for (const path of ['levels/0.vtu', series, 'poster.webp'])
    await expect(413, 'GET', `/v1/logs/${digest}/${path}`);
}

prepare(options);
for (const [check, more] of [
  [checkAll, undefined],
  [checkTooLarge, ['--max-level-bytes', '1']],
]) {
  const {child, port} = await startServer(options, more);
  try {
    await check(port);
  } finally {
    child.removeAllListeners('exit');
    child.kill('SIGTERM');
  }
}
agent.destroy();
for (const path of Object.values(description.paths))
  for (const operation of Object.values(path))
    for (const status of Object.keys(operation.responses ?? {})) {
      const name = `${operation.operationId} ${status}`;
      if (status !== 'default' && !seen.has(name) && !kUnasked.has(name))
        complain(name, 'is described and was never seen');
    }
console.log(
  complaints.length === 0
    ? `contract: ${seen.size} described answers seen, all as described`
    : complaints.join('\n'),
);
process.exit(complaints.length === 0 ? 0 : 1);
