// The right word that was probably meant by a wrong one.

/** A slip changes at most this share of the letters, but always one. */
const kSlipShare = 0.34;

/** The word with the fewest slips; null if none is near. Upper and lower case are the same. */
export function nearest(text: string, words: readonly string[]): string | null {
  let best: string | null = null;
  let least = Math.max(1, Math.floor(kSlipShare * text.length));
  for (const word of words) {
    const slips = slipsBetween(text.toLowerCase(), word.toLowerCase());
    if (slips < least || (slips === least && best === null)) [best, least] = [word, slips];
  }
  return best;
}

/** " Did you mean ...?", or nothing. */
export function hint(text: string, words: readonly string[]): string {
  const word = nearest(text, words);
  return word === null ? '' : ` Did you mean "${word}"?`;
}

/** Letters left out, put in, replaced, or two neighbours swapped (Damerau and Levenshtein). */
function slipsBetween(a: string, b: string): number {
  const rows = [Array.from({length: b.length + 1}, (_, k) => k)];
  for (let i = 1; i <= a.length; ++i) {
    const row = [i];
    for (let k = 1; k <= b.length; ++k) {
      const above = rows[i - 1]!;
      const swapped = i > 1 && k > 1 && a[i - 1] === b[k - 2] && a[i - 2] === b[k - 1];
      row[k] = Math.min(
        above[k]! + 1,
        row[k - 1]! + 1,
        above[k - 1]! + (a[i - 1] === b[k - 1] ? 0 : 1),
        swapped ? rows[i - 2]![k - 2]! + 1 : Infinity,
      );
    }
    rows.push(row);
  }
  return rows[a.length]![b.length]!;
}
