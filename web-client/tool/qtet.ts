#!/usr/bin/env node
// The command `qtet` of the npm package: the tool as WebAssembly.

import {spawn} from 'node:child_process';
import {existsSync, mkdtempSync, readFileSync, rmdirSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';
import {nodeHost, toolName, toolWord} from './node_host';
import {runTool} from './run_tool';

const beside = (name: string): string => fileURLToPath(new URL(name, import.meta.url));

/** Opens a page where there is a desktop. */
function openPage(url: string): void {
  const [program, ...words] =
    process.platform === 'win32'
      ? ['cmd', '/c', 'start', '', url]
      : [process.platform === 'darwin' ? 'open' : 'xdg-open', url];
  const hasDesktop =
    ['win32', 'darwin'].includes(process.platform) ||
    Boolean(process.env.DISPLAY ?? process.env.WAYLAND_DISPLAY);
  if (!hasDesktop) return;
  const opened = spawn(program, words, {detached: true, stdio: 'ignore'});
  opened.on('error', () => undefined); // the address is printed
  opened.unref();
}

const words = process.argv.slice(2).map((word) => toolWord(word));
const isView = words[0] === 'view';
const page = isView ? join(mkdtempSync(join(tmpdir(), 'qtet-node-view-')), 'page.html') : '';
const module = new WebAssembly.Module(readFileSync(beside('qtet-tool.wasm')));
const host = nodeHost({QTET_VIEWER: toolName(beside('viewer')), QTET_VIEW_PAGE: toolName(page)});
process.exitCode = runTool(module, words, host);
if (isView && !existsSync(page)) rmdirSync(dirname(page));
else if (isView) {
  const url = pathToFileURL(page).href;
  console.log(url);
  if (!words.includes('--no-open')) openPage(url);
}
