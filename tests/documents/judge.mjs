// Judges the examples of documents: each one ran, was only checked for a stated reason, is a text,
// or is wrong.

import {readFileSync, readdirSync} from 'node:fs';
import {join, resolve} from 'node:path';

import {blocksOf, commandsOf} from './blocks.mjs';
import {kLanguages, writeSource} from './examples.mjs';
import {Scratch} from './scratch.mjs';

/** Folders without documents of ours. */
const kNoDocuments = ['build', 'dist', 'node_modules'];

/** Says of a document that its examples make their files themselves. */
const kOwnFiles = '<!-- examples: in an empty folder -->';

/** The paths of all documents below a folder, relative to it. */
export function documentsIn(root, below = '') {
  return readdirSync(join(root, below), {withFileTypes: true})
    .filter(({name}) => !name.startsWith('.') && !kNoDocuments.includes(name))
    .flatMap((entry) => {
      const path = join(below, entry.name);
      if (entry.isDirectory()) return documentsIn(root, path);
      return entry.name.endsWith('.md') ? [path] : [];
    })
    .sort();
}

/**
 * The verdicts on a document's examples: `state` is `ran`, `checked`, `text`, `named` (a command of
 * the sentences) or `wrong`. `context`: root, build, inputs, out, options, python.
 */
export async function judge(document, context) {
  const text = readFileSync(resolve(context.root, document), 'utf8');
  const named = commandsOf(text).map((command) => judgeCommand(command, context.options));
  return [...named, ...(await judgeBlocks(document, text, context))];
}

function judgeCommand({line, text}, options) {
  const strangers = options.strangersIn(text);
  if (strangers.length === 0) return {line, language: 'command', state: 'named', note: ''};
  return {line, language: 'command', state: 'wrong', note: strangers.join('\n')};
}

async function judgeBlocks(document, text, context) {
  let blocks;
  try {
    blocks = blocksOf(text);
  } catch (error) {
    return [{line: 1, language: 'fence', state: 'wrong', note: error.message}];
  }
  if (blocks.every(({language}) => language === 'text')) return blocks.map(judgeText);
  const folder = join(context.out, document.replace(/[^A-Za-z0-9]+/g, '-'));
  const inputs = text.includes(kOwnFiles) ? null : context.inputs;
  const scratch = await Scratch.create({...context, inputs, folder});
  writeSource(blocks, scratch);
  try {
    return blocks.map((block) => judgeBlock(block, {...context, scratch}));
  } finally {
    scratch.stopServer();
  }
}

const judgeText = ({line}) => ({line, language: 'text', state: 'text', note: ''});

function judgeBlock(block, context) {
  const {line, language, note, reason} = block;
  if (language === 'text') return judgeText(block);
  const start = performance.now();
  try {
    const how = kLanguages[language];
    if (!how) throw new Error(`a fence of '${language}'; known: ${Object.keys(kLanguages)}, text`);
    if (note !== '' && reason === null && language !== 'json')
      throw new Error(`what is '${note}'?`);
    if (reason === '') throw new Error('no-run without a reason: write ```LANGUAGE no-run: REASON');
    const unrun = reason === null ? how.run(block, context) : how.check(block, context);
    const why = [reason, unrun].filter((part) => part).join('; ');
    const seconds = (performance.now() - start) / 1000;
    if (why !== '') return {line, language, state: 'checked', note: why};
    return {
      line,
      language,
      state: 'ran',
      note: '',
      did: how.did ?? `ran in ${seconds.toFixed(1)} s`,
    };
  } catch (error) {
    return {line, language, state: 'wrong', note: error.message};
  }
}
