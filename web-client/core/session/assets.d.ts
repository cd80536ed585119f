// The codec's WebAssembly, wherever the build put it (vite.config.ts).
declare module 'qtet-codec.wasm?url' {
  const url: string;
  export default url;
}
