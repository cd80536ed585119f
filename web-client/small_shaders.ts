// Build plugins that leave out what no minifier can tell from used code: the text of shaders, and
// parts of three.

import type {Plugin} from 'vite';

/** Our own shaders, without comments and indents: 1.3 kB less (gzip). */
const own: Plugin = {
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
};

/** Three puts these into the shaders of every ShaderMaterial. */
const kUsedChunks = ['colorspace_pars_fragment', 'tonemapping_pars_fragment'];
/** A chunk or a whole shader of three: `const NAME = "...";` on one line. */
const kChunk = /^(?:const|var) ([\w$]+) = "(?:[^"\\]|\\.)*\\n(?:[^"\\]|\\.)*";$/gm;
/** So many there are, at least. Fewer mean that three's form has changed. */
const kLeastChunks = 100;

/**
 * Three's own materials, which the viewer never uses: 65 kB (gzip) of shaders that no bundler can
 * tell from used ones.
 */
const three: Plugin = {
  name: 'no-material-shaders',
  apply: 'build',
  transform(code, id) {
    if (!/\/three\.module\.js$/.test(id)) return null;
    let removed = 0;
    const small = code.replace(kChunk, (chunk, name: string) => {
      if (kUsedChunks.includes(name)) return chunk;
      ++removed;
      return `var ${name} = "";`;
    });
    if (removed < kLeastChunks)
      this.error(`three has only ${removed} shaders in the known form: adapt small_shaders.ts`);
    return {code: small, map: null};
  },
};

/**
 * Parts that every renderer of three has and this viewer never uses: virtual reality, shadows and
 * surroundings that are mirrored. Each is here with the members that a renderer asks of it anyway.
 */
const kUnusedParts: Record<string, string> = {
  WebXRManager: `class WebXRManager extends EventDispatcher {
    enabled = false;
    isPresenting = false;
    getEnvironmentBlendMode() {}
    dispose() {}
  }`,
  WebGLShadowMap: `class WebGLShadowMap {
    enabled = false;
    render() {}
  }`,
  WebGLEnvironments: `class WebGLEnvironments {
    get(texture) { return texture; }
    dispose() {}
  }`,
};

const parts: Plugin = {
  name: 'no-unused-parts',
  apply: 'build',
  transform(code, id) {
    if (!/\/three\.module\.js$/.test(id)) return null;
    let small = code;
    for (const [name, part] of Object.entries(kUnusedParts)) {
      const whole = new RegExp(`^(?:class|function) ${name}\\b[\\s\\S]*?^\\}$`, 'm');
      if (!whole.test(small))
        this.error(`three's ${name} is not in the known form: adapt small_shaders.ts`);
      small = small.replace(whole, part);
    }
    return {code: small, map: null};
  },
};

export const smallShaders = (): Plugin[] => [own, three, parts];
