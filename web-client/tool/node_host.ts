// Node's files and streams for the tool. Windows' names have the form /C/folder/file there.

import {webcrypto} from 'node:crypto';
import fs from 'node:fs';
import os from 'node:os';
import tty from 'node:tty';
import {Exit, type HostFiles, type Streams} from './wasi';
import type {Host} from './run_tool';

/** A pipe that has nothing yet, or has no room, is asked again after so many ms. */
const kPauseMs = 5;
/** As a shell reports a program that SIGPIPE ended. */
const kNobodyReads = 141;

/** A share's name, `\\server\share\a`, has this before it in place of two slashes. */
const kShare = '/UNC/';

/** `C:\a\b` as the tool names it. Others keep their slashes. `\,` is a comma within a name. */
export function toolName(name: string, windows = isWindows): string {
  if (!windows) return name;
  const drive = /^([A-Za-z]):[\\/]/.exec(name);
  const slashes = name.replaceAll(/\\(?!,)/g, '/').replace(/^\/\/(?=[^/])/, kShare);
  return drive ? `/${drive[1]!.toUpperCase()}${slashes.slice(2)}` : slashes;
}

/** The host's name of a file that the tool names. */
export function hostName(name: string, windows = isWindows): string {
  if (windows && name.startsWith(kShare))
    return `\\\\${name.slice(kShare.length)}`.replaceAll('/', '\\');
  const drive = windows ? /^\/([A-Za-z])(\/.*)?$/s.exec(name) : null;
  return drive ? `${drive[1]}:${(drive[2] ?? '/').replaceAll('/', '\\')}` : name;
}

/** A word of the command line: a name, or an option with one. */
export function toolWord(word: string, windows = isWindows): string {
  const option = /^(--[a-z0-9-]+=)(.*)$/s.exec(word);
  return option ? option[1]! + toolName(option[2]!, windows) : toolName(word, windows);
}

// Node 18 has it under this name alone.
if (!('crypto' in globalThis)) Object.assign(globalThis, {crypto: webcrypto});

const isWindows = process.platform === 'win32';

const kPermissions = 0o7777;

/** The tool has no permissions (posix.h). So a file gets those of the one that it replaces. */
function rename(from: string, to: string): void {
  const replaced = fs.statSync(hostName(to), {throwIfNoEntry: false});
  if (replaced) fs.chmodSync(hostName(from), replaced.mode & kPermissions);
  fs.renameSync(hostName(from), hostName(to));
}

const files: HostFiles<number> = {
  open: (name, flags) => fs.openSync(hostName(name), flags),
  close: (file) => fs.closeSync(file),
  read: (file, bytes, at) => fs.readSync(file, bytes, 0, bytes.length, at),
  write: (file, bytes, at) => fs.writeSync(file, bytes, 0, bytes.length, at),
  sync: (file) => fs.fsyncSync(file),
  statusOf: (file) => fs.fstatSync(file),
  status: (name, followLink) => (followLink ? fs.statSync : fs.lstatSync)(hostName(name)),
  names: (folder) => fs.readdirSync(hostName(folder)),
  // Temporary folders are their owner's alone (simplify/portable/in_node.cpp).
  makeFolder: (name) =>
    fs.mkdirSync(hostName(name), /\/qtet-node-[^/]+$/.test(name) ? 0o700 : 0o777),
  removeFolder: (name) => fs.rmdirSync(hostName(name)),
  remove: (name) => fs.unlinkSync(hostName(name)),
  rename,
  link: (from, to) => fs.linkSync(hostName(from), hostName(to)),
  readLink: (name) => toolName(fs.readlinkSync(hostName(name))),
  constants: fs.constants,
};

/** Waits where a pipe that does not block has to be asked again. */
function patiently<T>(act: () => T): T {
  for (;;) {
    try {
      return act();
    } catch (error) {
      if ((error as NodeJS.ErrnoException).code !== 'EAGAIN') throw error;
      Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0, kPauseMs);
    }
  }
}

const streams: Streams = {
  read(bytes) {
    try {
      return patiently(() => fs.readSync(0, bytes));
    } catch (error) {
      if ((error as NodeJS.ErrnoException).code === 'EOF') return 0; // Windows
      throw error;
    }
  },
  write(stream, bytes) {
    try {
      for (let at = 0; at < bytes.length;)
        at += patiently(() => fs.writeSync(stream, bytes, at, bytes.length - at));
    } catch (error) {
      if ((error as NodeJS.ErrnoException).code === 'EPIPE') throw new Exit(kNobodyReads);
      throw error;
    }
  },
  isTerminal: (stream) => tty.isatty(stream),
};

/** This process as the tool sees it, and what `more` says beside. */
export function nodeHost(more: Readonly<Record<string, string>>): Host<number> {
  const names = {PWD: toolName(process.cwd()), TMPDIR: toolName(os.tmpdir())};
  const environment = {...(process.env as Record<string, string>), ...names, ...more};
  return {files, streams, environment};
}
