import { launch, openPage, settled } from './browser.mjs';
const browser = await launch();
const viewport = process.env.PHONE ? { width: 390, height: 780 } : { width: 1100, height: 720 };
const page = await openPage(browser, { viewport, hasTouch: !!process.env.PHONE });
for (const name of (process.argv[2] ?? 'face-centred,hexagonal,hexagonal-prism').split(',')) {
  await page.evaluate((lattice) => {
    const { bench } = globalThis.holdfast;
    const robot = bench.robot.inLattice(bench.robot.lattice);
    bench.history.replace('x', new robot.constructor(robot.lattice));
    bench.setLattice(lattice);
    const cells = [];
    for (let z = 0; z < 4; ++z) for (let x = 0; x < 4 - z; ++x) for (let y = 0; y < (lattice === 'hexagonal' ? 1 : 3); ++y) cells.push([x, y, z]);
    bench.edit('x', cells, 0);
    bench.edit('x', [cells[0]], 2);
    bench.edit('x', [cells[4]], 1);
    bench.surround('o', { obstacles: [{ from: [-2, -1, 0], to: [-2, 1, 3] }, { cells: [[4, 0, 0], [4,1,0]], hold: 'bonded' }] });
    globalThis.holdfast.app.see();
  }, name);
  await settled(page);
  await page.mouse.move(430, 300);
  await page.waitForTimeout(300);
  await page.screenshot({ path: `/tmp/shot_${name}${process.env.PHONE ? '_phone' : ''}.png` });
}
console.log(page.faults);
await browser.close();
