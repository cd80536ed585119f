// A folder that `qtet publish` made, on web servers that know nothing about it.

import assert from 'node:assert/strict';
import {expectWhole} from './expect.mjs';
import {publishedOnce} from './programs.mjs';
import {hostFolder} from './static_host.mjs';

async function showsAPublishedFolder(context) {
  const {browser, logs} = context;
  const folder = publishedOnce(context);
  for (const options of [{}, {nginx: false, ranges: false}]) {
    const host = await hostFolder(folder, options);
    try {
      const first = await browser.open(host.url);
      await first.waitForState('complete');
      await first.waitForPicture();
      await expectWhole(first, logs.fin);
      const menu = first.page.locator('qtet-viewer select[name=mesh] option');
      assert.deepEqual(await menu.allTextContents(), ['fin', 'box']);
      const chosen = await browser.open(`${host.url}?mesh=box&colormap=cividis`);
      await chosen.waitForState('complete');
      await expectWhole(chosen, logs.box);
      assert.deepEqual(
        host.requests.filter((line) => line.startsWith('/v1/')),
        [],
        'a server of ours was looked for',
      );
    } finally {
      host.close();
    }
  }
}

export const publishChecks = {showsAPublishedFolder};
