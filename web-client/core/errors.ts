// What goes wrong, as one type: a code to branch on and a text for people.

export class QtetError extends Error {
  constructor(
    readonly code: string,
    message: string,
  ) {
    super(message);
    this.name = 'QtetError';
  }
}

/** The text of anything that was thrown. */
export function errorText(thrown: unknown): string {
  return thrown instanceof Error ? thrown.message : String(thrown);
}

export function errorCode(thrown: unknown): string {
  return thrown instanceof QtetError ? thrown.code : 'internal';
}
