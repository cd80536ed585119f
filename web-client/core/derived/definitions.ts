// The text of several definitions, as an address has it: "Cp = p / 540; dT = T@2 - T@1".

/** The definitions of a text: a semicolon in a quoted name separates none. */
export function definitionsIn(text: string): string[] {
  const all = text.match(/(?:`[^`]*`|"[^"]*"|'[^']*'|[^;])+/g) ?? [];
  return all.map((its) => its.trim()).filter((its) => its !== '');
}
