// A build plugin that leaves import() as it is. No chunk of ours needs another one before it.

import type {Plugin} from 'vite';

/**
 * Vite would wrap import() in its own preloading: half a kilobyte of the page's script. The Vite of
 * a page that uses the package would take that for its own and call it without an address.
 */
export const plainDynamicImports = (): Plugin => ({
  name: 'plain-dynamic-imports',
  apply: 'build',
  configResolved({plugins}) {
    const at = plugins.findIndex(({name}) => name === 'vite:build-import-analysis');
    if (at < 0)
      throw new Error(
        'vite:build-import-analysis has another name: see that no chunk holds __vitePreload',
      );
    (plugins as Plugin[]).splice(at, 1);
  },
});
