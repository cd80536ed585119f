// proto/openapi.json, what the server is built with and serves, from proto/openapi.yaml, what
// people read and write.
import {readFileSync, writeFileSync} from 'node:fs';
import {parse} from 'yaml';

const at = (name) => new URL(`../../proto/${name}`, import.meta.url);
writeFileSync(
  at('openapi.json'),
  JSON.stringify(parse(readFileSync(at('openapi.yaml'), 'utf8'), {maxAliasCount: -1})) + '\n',
);
