// Whether shell commands name what there is: commands and options of qtet, options of qtet-server,
// targets of make.

import {execFileSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';

export class Options {
  #bin;
  #root;
  /** The programs' answers to --help or --help-all, by the words before it. */
  #help = new Map();

  constructor(bin, root) {
    this.#bin = bin;
    this.#root = root;
  }

  /** The names in a shell text's commands that do not exist, a sentence each. */
  strangersIn(text) {
    return commandsIn(text).flatMap(([program, ...words]) => {
      if (program === 'make') return this.#strangeTargets(words);
      if (program === 'qtet-server') return this.#strangeOptions([program], words);
      return program === 'qtet' ? this.#strangersOfTool(words) : [];
    });
  }

  #strangersOfTool([command = '', ...words]) {
    if (command.startsWith('-')) return this.#strangeOptions(['qtet'], [command]);
    if (!/^[a-z]/.test(command)) return []; // qtet COMMAND, a version
    const listed = new RegExp(`^ +${command} `, 'm').test(this.#helpOf(['qtet']));
    if (!listed) return [`qtet has no command '${command}'`];
    return this.#strangeOptions(['qtet', command], words);
  }

  #strangeOptions(command, words) {
    const known = new Set(this.#helpOf(command).match(/--[a-z][a-z0-9-]*/g));
    return words
      .map((word) => /^--[a-z][a-z0-9-]*/.exec(word)?.[0])
      .filter((option) => option !== undefined && !known.has(option))
      .map((option) => `${command.join(' ')} has no option ${option}`);
  }

  #helpOf([program, ...words]) {
    const key = [program, ...words].join(' ');
    if (!this.#help.has(key)) {
      const path = join(this.#bin, program);
      const asked = /^qtet( help)?$/.test(key) ? '--help' : '--help-all';
      this.#help.set(key, execFileSync(path, [...words, asked], {encoding: 'utf8'}));
    }
    return this.#help.get(key);
  }

  #strangeTargets(words) {
    const makefile = readFileSync(join(this.#root, 'Makefile'), 'utf8');
    return words
      .filter((word) => /^[a-z][a-z-]*$/.test(word))
      .filter((target) => !new RegExp(`^${target}:`, 'm').test(makefile))
      .map((target) => `the Makefile has no target '${target}'`);
  }
}

/** The simple commands of a shell text as words: the program's name, then what follows it. */
function commandsIn(text) {
  return text
    .replace(/\\\n/g, ' ')
    .replace(/(^|\s)#.*$/gm, '')
    .split(/[|;&()\n`]+/)
    .map((command) => command.trim().split(/\s+/))
    .map((words) => {
      const program = words.findIndex((word) => !/^(\w+=.*|sudo|nice|srun|env)$/.test(word));
      return program < 0
        ? ['']
        : [words[program].replace(/^.*\//, ''), ...words.slice(program + 1)];
    });
}
