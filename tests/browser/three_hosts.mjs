// The hosts of a mesh, as they are measured and shown (first_picture.mjs, film_strip.mjs).

import {execFileSync} from 'node:child_process';
import {rmSync} from 'node:fs';
import {basename, dirname, join} from 'node:path';
import {Server} from './programs.mjs';
import {hostFolder} from './static_host.mjs';

/**
 * [{what, port, close}] of a qtet-server and two hosts of the published folder. One sends its
 * compressed files, the other knows no coding, as nginx by default. The logs lie in one folder.
 */
export async function threeHosts({bin, viewer, out, logs}) {
  const server = new Server(bin, dirname(logs[0]), viewer);
  await server.start();
  const site = join(out, 'site');
  rmSync(site, {recursive: true, force: true});
  execFileSync(join(bin, 'qtet'), ['publish', site, ...logs, '--viewer', viewer]);
  const coded = await hostFolder(site, {nginx: false, codings: true});
  const plain = await hostFolder(site, {nginx: false});
  // The first visitor waits for the server to draw the poster; measured is a later one.
  for (const log of logs) {
    const name = encodeURIComponent(basename(log, '.qtet'));
    await (await fetch(`${server.url}v1/meshes/${name}/poster.webp`)).arrayBuffer();
  }
  return [
    {what: 'qtet-server', port: server.port, close: () => server.kill()},
    {what: 'published, compressed', port: coded.port, close: () => coded.close()},
    {what: 'published, not compressed', port: plain.port, close: () => plain.close()},
  ];
}
