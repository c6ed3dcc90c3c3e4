// usage: node watch_test.mjs WEB UNDERSTUDY SOURCE CHROMIUM: a rehearsal in the browser while it runs, and its report after.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const [web, understudy, source, program] = process.argv.slice(2);
if (!program || !existsSync(program)) {
  console.log('skipped: Chromium is not installed (Debian: chromium)');
  process.exit(77);
}
const { chromium } = createRequire(pathToFileURL(join(web, 'package.json')))('playwright-core');
const browser = await chromium.launch({ executablePath: program, args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
const folder = mkdtempSync(join(tmpdir(), 'understudy-watch-'));

const run = spawn(understudy, ['rehearse', join(source, 'scenarios/song-bottle.gcode'), '--fixture', 'bottle', '--watch', '--out', join(folder, 'out')]);
const ended = new Promise((resolve) => run.on('exit', resolve));
const address = await new Promise((resolve, reject) => {
  let said = '';
  run.stderr.on('data', (text) => {
    said += text;
    const found = /watch: (\S+)/.exec(said);
    if (found) resolve(found[1]);
  });
  run.on('exit', () => reject(new Error('it ended without an address: ' + said)));
});

try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  page.setDefaultTimeout(120000);
  const faults = [];
  page.on('console', (message) => { if (['error', 'warning'].includes(message.type()) && !/GPU stall|GL Driver|favicon/.test(message.text())) faults.push(message.text()); });
  page.on('pageerror', (error) => faults.push(String(error)));
  await page.goto(address);
  await page.waitForSelector('.verdict.running');
  await page.locator('.plots canvas').nth(2).waitFor();
  assert.match(await page.textContent('h1'), /song-bottle\.gcode on hexapod/);
  const share = await page.$eval('progress', (bar) => bar.value);
  assert.ok(share > 0 && share <= 1, 'share ' + share);
  if (process.env.UNDERSTUDY_PICTURES) await page.screenshot({ path: join(process.env.UNDERSTUDY_PICTURES, 'watch.png'), fullPage: true });
  // At its end the page is the report, by itself.
  await page.waitForSelector('.verdict.go, .verdict.go-with-warnings, .verdict.no-go');
  assert.ok([0, 1].includes(await ended));
  await page.waitForSelector('.scrub');
  assert.equal(await page.locator('progress').count(), 0);
  assert.deepEqual(faults, []);
  console.log('passed');
} finally {
  run.kill('SIGKILL');
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
