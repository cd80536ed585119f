// The gallery of .packaging/gallery.py: its page, and each of its links.

import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {kTimeoutMs} from './browser.mjs';
import {hostFolder} from './static_host.mjs';

const kSmall = {width: 480, height: 320};
const kScript = fileURLToPath(new URL('../../.packaging/gallery.py', import.meta.url));

async function everyLinkOfTheGalleryShowsItsView({browser, bin, out}) {
  const folder = join(out, 'gallery');
  execFileSync('python3', [kScript, folder, join(bin, '..')], {stdio: 'pipe'});
  const host = await hostFolder(folder);
  const page = await browser.page(host.url);
  try {
    const broken = await page
      .locator('img')
      .evaluateAll((all) => all.filter(({naturalWidth}) => naturalWidth === 0).map(({alt}) => alt));
    assert.deepEqual(broken, []);
    await browser.picture(page, 'gallery');
    await page.setViewportSize(kSmall); // a link's picture is not looked at
    const links = await page.locator('a').evaluateAll((all) => all.map(({href}) => href));
    for (const link of links) {
      await page.goto(link);
      await page.waitForFunction(
        () => ['complete', 'held', 'failed'].includes(window.qtetViewer?.state),
        null,
        {timeout: kTimeoutMs},
      );
      const alert = page.getByRole('alert');
      assert.equal(await alert.count(), 0, `${link}: ${await alert.allInnerTexts()}`);
      assert.notEqual(await page.evaluate(() => window.qtetViewer.state), 'failed', link);
    }
    return `${links.length} links`;
  } finally {
    await page.context().close();
    await host.close();
  }
}

export const galleryChecks = {everyLinkOfTheGalleryShowsItsView};
