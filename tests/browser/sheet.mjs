// A sheet of pictures with titles, as tests/bench shows them.

import {join} from 'node:path';
import {Browser} from './browser.mjs';

const kWidth = 300; // of a place whose picture is missing
const kHeight = 188;

/**
 * Writes OUT/NAME.jpg. `titles` stand over the columns. `rows` are [title, pictures]. A picture is
 * a data address or null; each is `height` pixels high.
 */
export async function drawSheet(out, name, titles, rows, height = kHeight) {
  const browser = await Browser.launch(out);
  const page = await browser.blank({viewport: {width: 100, height: 100}});
  const cell = (picture) => `<td>${picture ? `<img src="${picture}">` : '<i></i>'}</td>`;
  const row = ([title, pictures]) =>
    `<tr><th colspan="${titles.length}">${title}</th></tr>` +
    `<tr>${pictures.map(cell).join('')}</tr>`;
  await page.setContent(`<style>
      body { margin: 0; font: 14px system-ui, sans-serif; width: max-content; background: #fff; }
      th { font-weight: 600; text-align: left; padding: 4px; color: #333; }
      i { display: block; width: ${kWidth}px; height: ${height}px; background: #f2f2f2; }
      td { padding: 2px 4px; } img { display: block; height: ${height}px; }
    </style><table><tr>${titles.map((title) => `<th>${title}</th>`).join('')}</tr>
${rows.map(row).join('')}</table>`);
  await page.waitForFunction(() => [...document.images].every((image) => image.complete));
  const path = join(out, `${name}.jpg`);
  await page.locator('table').screenshot({path, type: 'jpeg', quality: 80});
  await browser.close();
  console.log(path);
}
