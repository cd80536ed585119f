// The viewer says what a page's policy lacks for WebAssembly, whatever words the browser has.

import {expect, test} from 'vitest';
import {decoderFailure, isForbidden, loadingCause} from '../core/protocol/wasm_policy';

const kRefusals = [
  // Chromium, before and since 95
  "WebAssembly.compileStreaming(): Wasm code generation disallowed by embedder: 'unsafe-eval'",
  'WebAssembly.compileStreaming(): Compiling or instantiating WebAssembly module violates the ' +
    "following Content Security policy directive because neither 'wasm-eval' nor 'unsafe-eval' " +
    'is an allowed source of script: "script-src \'self\'"',
  // Firefox
  'call to WebAssembly.compileStreaming() blocked by CSP',
  // Safari
  "Refused to create a WebAssembly object because 'unsafe-eval' or 'wasm-unsafe-eval' is not an " +
    'allowed source of script in the following Content Security Policy directive: "script-src".',
];

test.each(kRefusals)('%s', (text) => {
  const thrown = new WebAssembly.CompileError(text);
  expect(isForbidden(thrown)).toBe(true);
  const {code, message} = decoderFailure(thrown);
  expect(code).toBe('policy');
  expect(message).toMatch(/Content Security Policy .* script-src needs 'wasm-unsafe-eval'\)\.$/);
  expect(loadingCause(thrown)).not.toContain(text);
});

test.each(['expected magic word 00 61 73 6d', 'a.wasm: HTTP 500'])('%s', (text) => {
  expect(isForbidden(new Error(text))).toBe(false);
  const {code, message} = decoderFailure(new Error(text));
  expect(code).toBe('internal');
  expect(message).toBe(`The decoder could not be loaded (${text}). Reload the page.`);
});
