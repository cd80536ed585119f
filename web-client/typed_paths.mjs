// Declarations with whole paths: node's own resolution (node16, nodenext) guesses no endings.

import {existsSync, readdirSync, readFileSync, writeFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import typescript from 'typescript';

/** `text` with `.js` at the end of every relative path that it imports from; `..` is a folder. */
function withEndings(file, text) {
  const paths = typescript
    .preProcessFile(text, true, true)
    .importedFiles.filter(({fileName}) => /^\.\.?(\/|$)/.test(fileName) && !/\.js$/.test(fileName))
    .sort((a, b) => b.pos - a.pos); // from behind, so that positions stay right
  for (const {fileName, pos} of paths) {
    const ending = /(^|\/)\.\.?$/.test(fileName) ? '/index' : '';
    if (!existsSync(join(dirname(file), `${fileName}${ending}.d.ts`)))
      throw new Error(`${file} imports ${fileName}, which has no declarations`);
    const at = text.indexOf(fileName, pos) + fileName.length;
    text = `${text.slice(0, at)}${ending}.js${text.slice(at)}`;
  }
  return text;
}

/** Rewrites every .d.ts below `folder`. */
export function addEndings(folder) {
  for (const entry of readdirSync(folder, {recursive: true, withFileTypes: true})) {
    const file = join(entry.parentPath ?? entry.path, entry.name);
    if (!entry.isFile() || !file.endsWith('.d.ts')) continue;
    writeFileSync(file, withEndings(file, readFileSync(file, 'utf8')));
  }
}
