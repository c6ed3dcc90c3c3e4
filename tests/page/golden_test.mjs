// usage: node golden_test.mjs WEB SAMPLES PAGES GOLDEN CHROMIUM [update]: each kind of page against a coarse picture of it, panel by panel.
// SAMPLES holds what sample_report wrote, PAGES what write_pages.sh wrote, GOLDEN the pictures; `update` writes them anew: look at them then.
//
// Fonts differ from computer to computer, so panels are compared and not the page (a line that breaks elsewhere moves all below it), each
// scaled to the golden one's size, 160 px wide, and blurred by 7 px of these. A panel may be 12 % higher or lower, and 1.5 % of its pixels may
// differ by more than 20 of 255; one of less than 200 px, which is a few lines of text, may be 30 % higher or lower, and 20 % of it may
// differ. With UNDERSTUDY_FONTS=serif panels of text differ by 16 % at most, the others by 1.2 %; the least figure that is gone, one of the
// charts, makes 1.9 %.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const [web, samples, pages, golden, program, update] = process.argv.slice(2);
if (!program || !existsSync(program)) {
  console.log('skipped: Chromium is not installed (Debian: chromium)');
  process.exit(77);
}
const kWidth = 160, kBlur = 3, kDifference = 20, kShare = 0.015, kHeight = 0.12, kText = { below: 200, share: 0.2, height: 0.3 };
const { chromium } = createRequire(pathToFileURL(join(web, 'package.json')))('playwright-core');
// The fonts of the golden pictures alone, where they are there: others that are installed would be taken for system-ui.
const kFonts = '/usr/share/fonts/truetype/dejavu', scratch = mkdtempSync(join(tmpdir(), 'golden-')), config = join(scratch, 'fonts.conf');
writeFileSync(config, `<?xml version="1.0"?>\n<fontconfig><dir>${kFonts}</dir><include ignore_missing="yes">/etc/fonts/conf.d</include><cachedir>${scratch}</cachedir></fontconfig>\n`);
const env = existsSync(kFonts) ? { ...process.env, FONTCONFIG_FILE: config } : process.env;
const browser = await chromium.launch({ executablePath: program, env, args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });

const fonts = process.env.UNDERSTUDY_FONTS;  // another family, to see what it changes

const kinds = {
  'rehearsal': join(samples, 'no-go/report.html'),
  'rehearsal-go': join(samples, 'go/report.html'),
  'rehearsal-not-run': join(samples, 'stopped/report.html'),
  'comparison': join(samples, 'compared/go-no-go.html'),
  'calibration': join(pages, 'calibration/report.html'),
  'calibration-benchmark': join(pages, 'benchmark/report.html'),
  'gap-benchmark': join(pages, 'gap/gap.html'),
  'scenarios': join(pages, 'scenarios/index.html'),
  'campaign': join(pages, 'campaign/campaign.html'),
  'error-budget': join(pages, 'budget/budget.html'),
};

async function open(file) {
  const held = await browser.newContext({ viewport: { width: 1280, height: 900 }, colorScheme: 'light', reducedMotion: 'reduce', bypassCSP: Boolean(fonts) });
  const page = await held.newPage();
  page.setDefaultTimeout(120000);
  await page.goto(pathToFileURL(file).href);
  if (await page.$('body.report #record')) await page.waitForSelector('#page[data-ready]');
  await page.waitForTimeout(500);
  return page;
}

/** The children of the page: what they are, how large, and their pictures. */
async function panels(page) {
  const found = [];
  for (const handle of await page.$$('main > *, body > header')) {
    const box = await handle.boundingBox();
    if (!box || box.height < 8 || box.width < 8) continue;
    const name = await handle.evaluate((node) => [node.tagName.toLowerCase(), ...node.classList].join('.'));
    found.push({ name, width: Math.round(box.width), height: Math.round(box.height), png: (await handle.screenshot()).toString('base64') });
  }
  return found;
}

// What is done with pixels is done in a page of its own.
const desk = await browser.newPage();
await desk.evaluate(() => {
  const image = async (png) => {
    const loaded = new Image();
    loaded.src = 'data:image/png;base64,' + png;
    await loaded.decode();
    return loaded;
  };
  window.coarse = async (png, width, height) => {
    let from = await image(png), [w, h] = [from.width, from.height];
    const step = (to_w, to_h) => {
      const canvas = new OffscreenCanvas(to_w, to_h), context = canvas.getContext('2d');
      context.imageSmoothingQuality = 'high';
      context.drawImage(from, 0, 0, to_w, to_h);
      [from, w, h] = [canvas, to_w, to_h];
    };
    while (w > 2 * width && h > 2 * height) step(Math.ceil(w / 2), Math.ceil(h / 2));
    step(width, height);
    return from.getContext('2d').getImageData(0, 0, width, height);
  };
  /** All below each other as one PNG. */
  window.sheet = async (list) => {
    const canvas = new OffscreenCanvas(list[0].width, list.reduce((sum, each) => sum + each.height, 0));
    let y = 0;
    for (const { png, width, height } of list) {
      canvas.getContext('2d').putImageData(await window.coarse(png, width, height), 0, y);
      y += height;
    }
    const bytes = new Uint8Array(await (await canvas.convertToBlob({ type: 'image/png' })).arrayBuffer());
    return btoa(Array.from(bytes, (b) => String.fromCharCode(b)).join(''));
  };
  const blurred = ({ data, width, height }, radius) => {
    const out = new Float32Array(3 * width * height);
    for (let y = 0; y < height; ++y)
      for (let x = 0; x < width; ++x) {
        let count = 0;
        const sum = [0, 0, 0];
        for (let v = Math.max(0, y - radius); v <= Math.min(height - 1, y + radius); ++v)
          for (let u = Math.max(0, x - radius); u <= Math.min(width - 1, x + radius); ++u, ++count)
            for (let c = 0; c < 3; ++c) sum[c] += data[4 * (v * width + u) + c];
        for (let c = 0; c < 3; ++c) out[3 * (y * width + x) + c] = sum[c] / count;
      }
    return out;
  };
  /** The share of pixels that differ by more than `most`, of a panel and of a piece of a sheet. */
  window.differing = async (png, sheet, { y, width, height }, { radius, most }) => {
    const canvas = new OffscreenCanvas(width, height), context = canvas.getContext('2d');
    context.drawImage(await image(sheet), 0, -y);
    const a = blurred(await window.coarse(png, width, height), radius), b = blurred(context.getImageData(0, 0, width, height), radius);
    let count = 0;
    for (let i = 0; i < a.length; i += 3) if ([0, 1, 2].some((c) => Math.abs(a[i + c] - b[i + c]) > most)) ++count;
    return count / (a.length / 3);
  };
});

const coarseHeight = ({ width, height }) => Math.max(4, Math.round(kWidth * height / width));

async function write(kind, found) {
  const sheet = await desk.evaluate((list) => window.sheet(list), found.map((each) => ({ png: each.png, width: kWidth, height: coarseHeight(each) })));
  mkdirSync(golden, { recursive: true });
  writeFileSync(join(golden, kind + '.png'), Buffer.from(sheet, 'base64'));
  const lines = found.map(({ name, width, height }) => JSON.stringify({ name, width, height }));
  writeFileSync(join(golden, kind + '.json'), '[\n' + lines.join(',\n') + '\n]\n');
}

/** What differs, in words; [] where nothing does. `seen` gets the share of each panel. */
async function differences(kind, found, seen = []) {
  const expected = JSON.parse(readFileSync(join(golden, kind + '.json'), 'utf8')), sheet = readFileSync(join(golden, kind + '.png')).toString('base64');
  const names = (list) => list.map((each) => each.name).join(' ');
  if (names(found) !== names(expected)) return ['the panels are ' + names(found) + ', not ' + names(expected)];
  const said = [];
  let y = 0;
  for (let i = 0; i < found.length; ++i) {
    const want = expected[i], height = coarseHeight(want), higher = found[i].height / want.height - 1;
    const share = await desk.evaluate(([png, picture, place, how]) => window.differing(png, picture, place, how),
      [found[i].png, sheet, { y, width: kWidth, height }, { radius: kBlur, most: kDifference }]);
    y += height;
    seen.push({ name: want.name, share, higher });
    const text = want.height < kText.below;
    if (Math.abs(higher) > (text ? kText.height : kHeight)) said.push(want.name + ' is ' + found[i].height + ' px high, not ' + want.height);
    if (share > (text ? kText.share : kShare)) said.push(want.name + ': ' + (100 * share).toFixed(1) + ' % of its picture differ');
  }
  return said;
}

/** Faults that the comparison must see: each takes something off the page. */
const mutations = {
  'a chart of the plots': ['rehearsal', '.plot-grid figure:nth-child(2)'],
  'the replay': ['rehearsal', '.view'],
  'the program': ['rehearsal', '.program'],
  'the causes': ['rehearsal', '.causes'],
  'the curve of a chart': ['comparison', '.plot-grid svg'],
  'a table': ['calibration', 'table'],
};

let failed = 0;
const report = (name, said) => {
  console.log((said.length ? 'FAIL ' : 'ok   ') + name + (said.length ? ': ' + said.join('; ') : ''));
  failed += said.length > 0;
};
for (const [kind, file] of Object.entries(kinds)) {
  const page = await open(file);
  if (fonts) await page.addStyleTag({ content: '* { font-family: ' + fonts + ' !important; }' }).catch(() => {});
  const found = await panels(page);
  const seen = [];
  if (update === 'update') await write(kind, found);
  const said = await differences(kind, found, seen);
  report(kind, said);
  const worst = seen.sort((a, b) => b.share - a.share)[0];
  if (worst) console.log(`     ${worst.name} differs most, ${(100 * worst.share).toFixed(2)} %; heights by ${(100 * Math.max(...seen.map((s) => Math.abs(s.higher)))).toFixed(1)} %`);
  for (const [what, [of, selector]] of Object.entries(mutations)) {
    if (of !== kind || fonts) continue;
    const damaged = await open(file);
    await damaged.evaluate((which) => { document.querySelector(which).style.visibility = 'hidden'; }, selector);
    const noticed = [];
    const words = await differences(kind, await panels(damaged), noticed);
    report('notices without ' + what, words.length ? [] : ['nothing differs: ' + JSON.stringify(noticed)]);
    await damaged.context().close();
  }
  await page.context().close();
}
await browser.close();
rmSync(scratch, { recursive: true, force: true });
process.exit(failed ? 1 : 0);
