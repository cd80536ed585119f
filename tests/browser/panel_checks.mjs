// The panel and what lies in the picture's corners: found at once, folded, reached by keyboard.

import assert from 'node:assert/strict';
import {PoorLine} from './poor_line.mjs';

async function opened({server, browser}, query, device, before) {
  const viewer = await browser.open(`${server.url}?${query}`, device, before);
  await viewer.waitForState('complete');
  await viewer.waitForPicture();
  return viewer;
}

/** A slip in a link is answered by the word that was probably meant. */
async function namesTheNearestWord(context) {
  const viewer = await opened(context, 'mesh=box&colourmap=turbo&utm_source=mail');
  const alert = viewer.page.getByRole('alert');
  assert.match(await alert.innerText(), /"colourmap", which .* Did you mean "colormap"\?/);
  assert.doesNotMatch(await alert.innerText(), /utm/);
  await viewer.screenshot('panel-slip');
  const other = await opened(context, 'mesh=fin&field=Presure&colormap=viridsi');
  const said = await other.page.getByRole('alert').innerText();
  assert.match(said, /no field "Presure"\. Did you mean "Pressure"\?/);
  assert.match(said, /Did you mean "viridis"\?/);
}

/** Nothing "stays on the screen" if the damage came before the first picture. */
async function promisesNothingOfADamagedHead({server, browser}) {
  const notes = [];
  for (const damageAt of [400, 1200, 4000]) {
    const line = await PoorLine.open(server.port, {streamsOnly: true, damageAt});
    try {
      const viewer = await browser.open(`${line.url}?mesh=fin`);
      await viewer.waitForState('failed');
      const said = await viewer.page.getByRole('alert').innerText();
      assert.doesNotMatch(said, /stays/, `byte ${damageAt}`);
      notes.push(`byte ${damageAt}: ${said.split('\n')[0]}`);
    } finally {
      line.close();
    }
  }
  return notes.join('; ');
}

export const panelChecks = {
  namesTheNearestWord,
  promisesNothingOfADamagedHead,
};
