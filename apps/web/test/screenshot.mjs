// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The README's picture of the page. `node test/screenshot.mjs` in apps/web renews docs/page.jpg.
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { facePoint, launch, openPage, repository, settled } from './browser.mjs';

export const pictureFile = path.join(repository, 'docs/page.jpg');

/** The strong arm with two modules planned at its tip, and the pointer where a third may not go. */
export async function takePicture(browser, options) {
  const page = await openPage(browser, { viewport: { width: 1160, height: 680 } });
  await page.click('#roles button >> text=Planned');
  const { x, y } = await facePoint(page, [5, 1, 2], [0, 0, 1]);
  await page.mouse.move(x, y);
  await page.waitForFunction(() => globalThis.holdfast.app.whereNext.places.known([5, 1, 3], 1));
  await settled(page);
  const picture = await page.screenshot(options);
  await page.close();
  return picture;
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const browser = await launch();
  await takePicture(browser, { path: process.argv[2] ?? pictureFile, ...(process.argv[2] ? {} : { type: 'jpeg', quality: 60 }) });
  await browser.close();
}
