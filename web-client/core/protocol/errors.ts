// The one error type: a code to branch on and a text for people.

export class QtetError extends Error {
  constructor(
    readonly code: string,
    message: string,
  ) {
    super(message);
    this.name = 'QtetError';
  }
}

/** The message of anything that was thrown. */
export function errorText(thrown: unknown): string {
  return thrown instanceof Error ? thrown.message : String(thrown);
}

export function errorCode(thrown: unknown): string {
  return thrown instanceof QtetError ? thrown.code : 'internal';
}
