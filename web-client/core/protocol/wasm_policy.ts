// A page whose Content Security Policy forbids WebAssembly.

import {errorText, QtetError} from './errors';

/** CompileErrors of Chromium, Firefox and Safari have no code, and name the policy each its way. */
const kNamesPolicy = /Content[- ]Security[- ]Policy|\bCSP\b|unsafe-eval/i;

/** Whether WebAssembly was refused by the page's policy. It will be refused again. */
export function isForbidden(thrown: unknown): boolean {
  return kNamesPolicy.test(errorText(thrown));
}

/** Why a module could not be loaded, as a clause. */
export function loadingCause(thrown: unknown): string {
  if (!isForbidden(thrown)) return errorText(thrown);
  return (
    "this page's Content Security Policy forbids WebAssembly: its script-src needs " +
    "'wasm-unsafe-eval'"
  );
}

/** `policy` or `internal`, with what to do. */
export function decoderFailure(thrown: unknown): QtetError {
  const because = `The decoder could not be loaded (${loadingCause(thrown)}).`;
  return isForbidden(thrown)
    ? new QtetError('policy', because)
    : new QtetError('internal', `${because} Reload the page.`);
}
