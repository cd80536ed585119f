// Fields that are wanted behind the shown ones.

/** So many are asked for at once. A server takes 1,024 names in a request. */
export const kMaxAhead = 512;

export class FieldsAhead {
  /** The playing series shows them soon. */
  playing: readonly number[] = [];
  /** Their values are listed: parts. */
  listed: readonly number[] = [];
  /** They are plotted over time. */
  plotted: readonly number[] = [];
  /**
   * The instant that a movie shows instead of the attribute's, and the fields that it shows soon;
   * null: no movie is made.
   */
  filmed: {time: number; ahead: readonly number[]} | null = null;

  /** Those to ask for now. `here` are those that have come. */
  request(here: readonly number[]): number[] {
    const {filmed, listed, playing, plotted} = this;
    const all = [...new Set([...(filmed?.ahead ?? []), ...listed, ...playing, ...plotted])];
    if (all.length <= kMaxAhead) return all;
    const isHere = new Set(here);
    return all.filter((field) => !isHere.has(field)).slice(0, kMaxAhead);
  }
}
