// A page as a picture, by headless Chromium: docs/pictures/report.png is
//   build/release/cli/understudy rehearse scenarios/song-bottle.gcode --machine hexapod --fixture bottle --seed 4 --out out/picture
//   node scripts/page_picture.mjs build/release/web out/picture/report.html docs/pictures/report.png
// usage: node page_picture.mjs WEB PAGE OUT.png [WIDTH HEIGHT [light|dark [all]]]   WEB holds node_modules; `all` takes the whole page.
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [web, page, out, width = '1280', height = '960', colorScheme = 'light', extent = ''] = process.argv.slice(2);
const program = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);
if (!out || !program) {
  console.error(out ? 'page_picture: Chromium is not installed (Debian: chromium)' : 'usage: node page_picture.mjs WEB PAGE OUT.png [WIDTH HEIGHT [light|dark [all]]]');
  process.exit(2);
}
const { chromium } = createRequire(pathToFileURL(resolve(web, 'package.json')))('playwright-core');
const browser = await chromium.launch({ executablePath: program, args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
const shown = await browser.newPage({ viewport: { width: Number(width), height: Number(height) }, colorScheme });
shown.on('pageerror', (error) => console.error(String(error)));
await shown.goto(pathToFileURL(resolve(page)).href, { timeout: 180000 });
await shown.waitForSelector('#page[data-ready]');
// Well into the print: what the page is for.
await shown.evaluate(() => {
  const scrub = document.querySelector('.scrub');
  if (!scrub) return;
  scrub.value = String(0.2 * Number(scrub.min) + 0.8 * Number(scrub.max));
  scrub.dispatchEvent(new Event('input'));
});
await shown.waitForTimeout(1500);
await shown.screenshot({ path: out, fullPage: extent === 'all' });
await browser.close();
