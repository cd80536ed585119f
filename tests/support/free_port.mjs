// free_port.sh for scripts of node.
import {execFileSync} from 'node:child_process';
import {fileURLToPath} from 'node:url';

const kScript = fileURLToPath(new URL('free_port.sh', import.meta.url));

export const freePort = () => Number(execFileSync(kScript, {encoding: 'utf8'}));
