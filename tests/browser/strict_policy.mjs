// As strict as a Content Security Policy can be for a page with workers and WebAssembly.

export const kStrictPolicy =
  "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; " +
  "object-src 'none'; base-uri 'none'; trusted-types qtet default; " +
  "require-trusted-types-for 'script'";
