import { launch, openPage, openExample } from './browser.mjs';
const browser = await launch();
for (const [n,f] of [['old','/work/main/build/page/holdfast.html'],['new','/work/wt/page/build/page/holdfast.html']]) {
  const page = await openPage(browser, { file: f, viewport: { width: 900, height: 560 } });
  await openExample(page, 'angle_breaks_c');
  await page.mouse.move(0,0);
  await page.screenshot({ path: `/tmp/cmp_${n}.png` });
}
await browser.close();
