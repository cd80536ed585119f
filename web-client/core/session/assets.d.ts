// The WebAssembly, wherever the build put it (vite.config.ts): the codec, and its part that decodes
// the base mesh.
declare module 'qtet-codec.wasm?url' {
  const url: string;
  export default url;
}
declare module 'qtet-base.wasm?url' {
  const url: string;
  export default url;
}
/** The simplifier, which a page loads when a mesh is dropped. */
declare module 'qtet-simplify.wasm?url' {
  const url: string;
  export default url;
}
