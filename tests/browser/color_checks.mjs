// Own colour maps, steps, and colours beyond the range.

import assert from 'node:assert/strict';
import {kDesktop, kPhone} from './browser.mjs';
import {drop} from './drop_checks.mjs';

const kOwn = 'custom:0=0000ff,0.5=ffffff,1=ff0000';
const kFile = JSON.stringify([
  {Name: 'flag', ColorSpace: 'RGB', RGBPoints: [-1, 0, 0, 1, 0, 1, 1, 1, 1, 1, 0, 0]},
]);

function countOf({width, height, at}, color) {
  let count = 0;
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) if (String(at(x, y)) === String(color)) ++count;
  return count;
}

async function ownColoursStepsAndColoursBeyondTheRange({server, browser}) {
  const address = `${server.url}?mesh=fin&field=Density&range=1,2.5&edges=off`;
  for (const [name, device] of [
    ['desktop', kDesktop],
    ['phone-dark', {...kPhone, colorScheme: 'dark'}],
  ]) {
    const viewer = await browser.open(address, device);
    await viewer.waitForState('complete');
    await viewer.waitForPicture();
    const {page} = viewer;
    const attribute = (its) => page.evaluate((key) => window.qtetViewer.getAttribute(key), its);
    await drop(viewer, ['flag.json', Buffer.from(kFile)]);
    await page.waitForFunction((its) => window.qtetViewer.getAttribute('colormap') === its, kOwn);
    if (name !== 'desktop') await page.getByRole('button', {name: 'Controls'}).click();
    const steps = page.getByRole('textbox', {name: 'Steps'});
    await steps.fill('6');
    await steps.press('Enter');
    assert.equal(await attribute('colormap'), `${kOwn}/6`);
    await page.getByRole('checkbox', {name: 'Beyond'}).check({force: true});
    await page.getByLabel('Colour above the range').fill('#00c000');
    assert.equal(await attribute('beyond'), '8c8c8c,00c000');
    await viewer.settle();
    assert.deepEqual(await viewer.accessibilityViolations(), []);
    const picture = await viewer.screenshot(`colours-${name}`);
    assert.ok(countOf(picture, [0, 192, 0]) > 100, 'no colour above the range');
    await drop(viewer, ['bad.json', Buffer.from('[{"ColorSpace":"Step","RGBPoints":[]}]')]);
    await page.getByText('"Step", which is not understood').waitFor();
    assert.equal(await attribute('colormap'), `${kOwn}/6`);
  }
}

export const colorChecks = {ownColoursStepsAndColoursBeyondTheRange};
