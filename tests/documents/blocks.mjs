// The examples of a document: its fenced blocks, and the commands that its sentences name.

const kFence = /^ *```(.*)$/;
const kNoRun = /^no-run(?:: *(.*))?$/;

/**
 * The fenced blocks of a text: `line` of the fence, `language`, `note` (its other words), `text`.
 * `reason` is there if the note says why it is not run here.
 */
export function blocksOf(document) {
  const blocks = [];
  let open = null;
  for (const [index, line] of document.split('\n').entries()) {
    const fence = kFence.exec(line);
    if (!fence) {
      open?.lines.push(line);
    } else if (open) {
      blocks.push({...open.head, text: `${open.lines.join('\n')}\n`});
      open = null;
    } else {
      open = {head: headOf(fence[1].trim(), index + 1), lines: []};
    }
  }
  if (open) throw new Error(`line ${open.head.line}: this fence is never closed`);
  return blocks;
}

function headOf(info, line) {
  const [language, ...words] = info.split(' ');
  const note = words.join(' ');
  const noRun = kNoRun.exec(note);
  return {line, language, note, reason: noRun ? (noRun[1] ?? '') : null};
}

/** Commands in the sentences, `qtet ...`, `qtet-server ...` and `make ...`, with their lines. */
export function commandsOf(document) {
  const prose = document.replace(/^ *```[^]*?^ *```$/gm, (block) => block.replace(/[^\n]/g, ''));
  return [...prose.matchAll(/`((?:qtet|qtet-server|make) [^`]+)`/g)].map((match) => ({
    line: prose.slice(0, match.index).split('\n').length,
    text: match[1].replace(/\s+/g, ' '),
  }));
}

/** JSON values one behind the other. */
export function jsonValuesOf(text) {
  const values = [];
  let rest = text.trim();
  while (rest !== '') {
    const end = endOfValue(rest);
    values.push(JSON.parse(rest.slice(0, end)));
    rest = rest.slice(end).trim();
  }
  if (values.length === 0) throw new Error('there is no value');
  return values;
}

/** Where the first value ends: behind the bracket that closes the first one, else at the end. */
function endOfValue(text) {
  let depth = 0;
  for (const token of text.matchAll(/"(?:[^"\\]|\\.)*"|[[\]{}]/g)) {
    if ('[{'.includes(token[0])) ++depth;
    if (']}'.includes(token[0])) --depth;
    if (depth === 0) return token.index + token[0].length;
  }
  return text.length;
}
