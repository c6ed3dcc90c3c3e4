// usage: node page_test.mjs WEB SAMPLES CHROMIUM KIND: WEB holds node_modules, SAMPLES the folders that sample_report wrote.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const [web, samples, program, kind] = process.argv.slice(2);
if (!program || !existsSync(program)) {
  console.log('skipped: Chromium is not installed (Debian: chromium)');
  process.exit(77);
}
const require = createRequire(pathToFileURL(join(web, 'package.json')));
const { chromium } = require('playwright-core');
const axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');
const browser = await chromium.launch({ executablePath: program, args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });

const withoutWebGl = () => { HTMLCanvasElement.prototype.getContext = new Proxy(HTMLCanvasElement.prototype.getContext, {
  apply: (target, self, [type, ...rest]) => (/webgl/.test(type) ? null : Reflect.apply(target, self, [type, ...rest])) }); };

/** The page of a sample, and what its console complained of. `flat`: without the picture of the machine, which takes most of the time. */
async function open(name, options = {}) {
  const { flat, ...context } = options;
  const held = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...context });
  const page = await held.newPage();
  page.setDefaultTimeout(120000);  // beside other work a browser takes long
  page.faults = [];
  page.on('console', (message) => { if (['error', 'warning'].includes(message.type()) && !(flat ? /creating WebGL context/ : /GPU stall|GL Driver/).test(message.text())) page.faults.push(message.text()); });
  page.on('pageerror', (error) => page.faults.push(String(error)));
  page.on('request', (request) => { if (!/^(file|data|blob):/.test(request.url())) page.faults.push('asks for ' + request.url()); });
  if (flat) await page.addInitScript(withoutWebGl);
  page.session = await held.newCDPSession(page);
  await page.session.send('Performance.enable', { timeDomain: 'threadTicks' });
  await page.goto(pathToFileURL(name.includes('/') ? name : join(samples, name, 'report.html')).href);
  await page.waitForSelector('#page[data-ready]');
  return page;
}

const time = (page) => page.$eval('.scrub', (node) => Number(node.value));
const line = (page) => page.$eval('.lines .now', (node) => Number(node.dataset.line));

const tests = {
  async 'opens from disk without a complaint, a request or a missing part'() {
    for (const name of ['go', 'no-go', 'without-gap-control', 'stopped', 'without-replay', 'in-air', 'calibrated', 'believing']) {
      const page = await open(name);
      assert.deepEqual(page.faults, [], name);
      assert.ok(await page.$('.verdict strong'), name);
      const text = await page.innerText('#page');
      for (const word of ['NaN', 'undefined', '[object', 'Infinity']) assert.ok(!text.includes(word), name + ' says ' + word);
      await page.context().close();
    }
  },
  async 'a finding that is pressed moves replay, program and readings to its place'() {
    const page = await open('no-go', { flat: true });
    const record = await page.$eval('#record', (node) => JSON.parse(node.textContent));
    const groups = record.summary.finding_groups;
    for (const i of [1, 0]) {
      await page.click('.causes li:nth-child(' + (i + 1) + ') .cause');
      assert.ok(Math.abs(await time(page) - groups[i].worst.time_s) < 1e-3);
      const [now] = await page.$$eval('.readings dd', (nodes) => nodes.map((n) => n.textContent));
      assert.equal(Number(now), await line(page));
    }
    assert.match(await page.textContent('.causes'), /What to do|limit/);
    await page.context().close();
  },
  async 'causes are grouped, ahead of what comes of them, and each finding is folded'() {
    const page = await open('no-go', { flat: true });
    assert.equal(await page.textContent('.verdict strong'), 'NO-GO');
    assert.equal(await page.locator('.causes > ol .severity.error').count(), 2);
    assert.equal(await page.locator('.causes > ol .severity.warning').count(), 1);
    await page.click('summary:has-text("Each of the 30 findings")');
    await page.locator('.findings tbody tr').first().waitFor();  // rows are made when the part unfolds
    assert.equal(await page.locator('.findings tbody tr').count(), 30);
    await page.click('.findings tbody tr:nth-child(5) button');
    const record = await page.$eval('#record', (node) => JSON.parse(node.textContent));
    assert.ok(Math.abs(await time(page) - record.summary.findings[4].time_s) < 1e-3);
    await page.context().close();
  },
  async 'curves before and after a calibration, and what the controller believes'() {
    const page = await open('calibrated', { flat: true });
    assert.equal(await page.locator('.comparison').count(), 1);
    assert.match(await page.textContent('.comparison'), /100/);
    await page.context().close();
    const other = await open('believing', { flat: true });
    assert.match(await other.textContent('.plots'), /Blue band: what the controller believes.*inside on 25\.0/s);
    await other.context().close();
    const stopped = await open('stopped');
    assert.match(await stopped.textContent('#page'), /The program was not run/);
    assert.equal(await stopped.locator('canvas').count(), 0);
    await stopped.context().close();
  },
  async 'scrubbing, keys and the play button move the instant, and the print grows with it'() {
    const page = await open('go');
    const scrub = page.locator('.scrub');
    const [start, end] = await scrub.evaluate((n) => [Number(n.min), Number(n.max)]);
    const at = async (value) => { await scrub.evaluate((n, v) => { n.value = v; n.dispatchEvent(new Event('input')); }, value); return line(page); };
    const first = await at(start), last = await at(end);
    assert.ok(last > first);
    await scrub.focus();
    await page.keyboard.press('ArrowLeft');
    assert.ok(await time(page) < end);
    await page.keyboard.press('n');
    await page.click('.next-finding').catch(() => {});
    await at(start);
    await page.click('.play');
    for (let i = 0; i < 100 && await time(page) <= start + 0.01; ++i) await page.waitForTimeout(50);
    assert.ok(await time(page) > start + 0.01);
    await page.click('.play');
    await page.context().close();
  },
  async 'the picture shows beads only once they are laid'() {
    const page = await open('go');
    await page.selectOption('.replay-controls label:has-text("Colour") select', 'plain');
    await page.selectOption('.replay-controls label:has-text("Machine") select', 'hidden');
    await page.click('button:text-is("part")');
    const picture = async (value) => {
      await page.locator('.scrub').evaluate((n, v) => { n.value = v; n.dispatchEvent(new Event('input')); }, value);
      await page.waitForTimeout(250);
      const png = await page.locator('.view canvas').screenshot();
      return page.evaluate(async (base64) => {
        const image = new Image();
        image.src = 'data:image/png;base64,' + base64;
        await image.decode();
        const canvas = document.createElement('canvas');
        canvas.width = image.width; canvas.height = image.height;
        const context = canvas.getContext('2d');
        context.drawImage(image, 0, 0);
        const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
        let near = 0;
        // Of the plastic's hue, in light and in shade.
        for (let i = 0; i < data.length; i += 4) if (data[i] > 1.4 * data[i + 1] && data[i + 1] > 1.2 * data[i + 2] && data[i] > 90) ++near;
        return near;
      }, png.toString('base64'));
    };
    const none = await picture(6), half = await picture(12), all = await picture(18);
    assert.ok(half > none + 200 && all > half + 200, `plastic pixels at the start, half-way and at the end: ${none}, ${half}, ${all}`);
    await page.context().close();
  },
  async 'every colour mode has a key of its own'() {
    const page = await open('no-go');
    const select = page.locator('.replay-controls label:has-text("Colour") select');
    const modes = await select.locator('option').evaluateAll((nodes) => nodes.map((n) => n.value));
    assert.deepEqual(modes, ['gap', 'tip', 'turn', 'speed', 'width', 'order', 'type', 'plain']);
    const keys = new Set();
    for (const mode of modes) {
      await select.selectOption(mode);
      keys.add(await page.$eval('.colour-key', (n) => n.innerHTML));
    }
    assert.equal(keys.size, modes.length);
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },
  async 'loads, temperature and clearance are curves over time, and a press on each moves the replay'() {
    const page = await open('go', { flat: true });
    const figure = (title) => page.locator('.plot-grid figure', { has: page.locator('b', { hasText: title }) });
    for (const title of ['Clearance of the nozzle', 'Temperature', 'Strut forces']) {
      const over = figure(title).locator('.u-over');
      await over.scrollIntoViewIfNeeded();
      const box = await over.boundingBox();
      await page.mouse.click(box.x + 0.25 * box.width, box.y + 60);
      const early = await time(page);
      await page.mouse.click(box.x + 0.75 * box.width, box.y + 60);
      // Half of a run of 18 s.
      assert.ok(Math.abs(await time(page) - early - 9) < 1.5, title + ': from ' + early + ' to ' + await time(page));
    }
    assert.match(await figure('Strut forces').textContent(), /5 flips: the load changes its side/);
    assert.match(await figure('Temperature').textContent(), /glass transition, 60\u00a0°C/);
    assert.deepEqual(page.faults, []);
    await page.context().close();
    const older = await open('without-gap-control', { flat: true });
    assert.equal(await older.locator('.plot-grid b', { hasText: /Clearance of|Temperature|Strut forces/ }).count(), 0);
    assert.ok(await older.locator('.plot-grid figure').count() > 3);
    await older.context().close();
  },
  async 'a press on a curve moves the replay'() {
    const page = await open('go', { flat: true });
    const over = page.locator('.plot-grid figure').nth(-1).locator('.u-over');
    await over.scrollIntoViewIfNeeded();
    const before = await time(page), box = await over.boundingBox();
    await page.mouse.click(box.x + 0.75 * box.width, box.y + 60);
    assert.ok(Math.abs(await time(page) - before) > 0.5);
    await page.context().close();
  },
  async 'light and dark follow the system and the switch'() {
    const page = await open('go', { colorScheme: 'dark' });
    const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.equal(await ground(), 'rgb(20, 25, 29)');
    await page.click('.theme');
    assert.equal(await ground(), 'rgb(255, 255, 255)');
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },
  async 'nothing is wider than the screen, from a phone to a wall'() {
    for (const name of ['no-go', 'stopped', 'hostile']) {
      const page = await open(name, { flat: name !== 'no-go', viewport: { width: 390, height: 844 } });
      await page.evaluate(() => { for (const d of document.querySelectorAll('details')) d.open = true; });
      for (const width of [390, 1280, 1920]) {
        await page.setViewportSize({ width, height: 844 });
        await page.waitForTimeout(150);
        const wide = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(wide <= width, `${name} at ${width} px is ${wide} px wide`);
      }
      await page.context().close();
    }
  },
  async 'paper shows the pictures, every folded part and no controls'() {
    const page = await open('no-go', { flat: true });
    await page.emulateMedia({ media: 'print' });
    await page.evaluate(() => window.dispatchEvent(new Event('beforeprint')));
    const seen = (selector) => page.locator(selector).first().isVisible();
    assert.ok(await seen('.pictures img') && await seen('.causes') && await seen('.figures table'));
    assert.ok(!await seen('.scrub') && !await seen('.theme'));
    assert.ok((await page.pdf({ format: 'A4' })).length > 10000);
    await page.context().close();
  },
  async 'axe finds nothing serious'() {
    for (const colorScheme of ['light', 'dark'])
      for (const name of ['no-go', 'stopped']) {
        const page = await open(name, { colorScheme, flat: colorScheme === 'dark', bypassCSP: true });
        await page.evaluate(() => { for (const d of document.querySelectorAll('details')) d.open = true; });
        await page.evaluate(axe);
        const found = await page.evaluate(() => axe.run());
        const grave = found.violations.filter((v) => ['serious', 'critical'].includes(v.impact))
          .map((v) => v.id + ': ' + v.nodes.slice(0, 3).map((n) => n.target.join(' ') + ' ' + (n.any[0]?.message || '')).join(' | '));
        assert.deepEqual(grave, [], name + ' ' + colorScheme);
        await page.context().close();
      }
  },
  async 'without WebGL the rest of the page works and says so'() {
    const page = await open('no-go', { flat: true });
    assert.match(await page.textContent('.no-webgl'), /no WebGL/);
    await page.click('.causes .cause');
    assert.ok(await line(page) > 0);
    assert.ok(await page.locator('.pictures img').first().isVisible());
    await page.context().close();
  },
  async 'two rehearsals beside each other: the answer, what differs, and both curves'() {
    const page = await open(join(samples, 'compared/go-no-go.html'));
    assert.match(await page.textContent('.verdict strong'), /GO with warnings \u2192 NO-GO/);
    assert.equal(await page.locator('.plot-grid svg').count(), 4);
    const box = await page.locator('.plot-grid svg polyline[stroke="#0072b2"]').first().boundingBox();
    assert.ok(box.width > 200, 'the curve is ' + box.width + ' px wide');
    assert.deepEqual(page.faults, []);
    await page.context().close();
    for (const name of ['compared/hostile-go.html', 'compared/stopped-go.html', 'compared/go-go.html']) {
      const other = await open(join(samples, name), { viewport: { width: 390, height: 844 } });
      assert.equal(await other.evaluate(() => window.evil), undefined, name);
      const text = await other.innerText('#page');
      for (const word of ['NaN', 'undefined', 'inf ']) assert.ok(!text.includes(word), name + ' says ' + word);
      for (const width of [390, 1280]) {
        await other.setViewportSize({ width, height: 844 });
        const wide = await other.evaluate(() => document.documentElement.scrollWidth);
        assert.ok(wide <= width, `${name} at ${width} px is ${wide} px wide`);
      }
      assert.deepEqual(other.faults, [], name);
      await other.context().close();
    }
  },
  async 'axe finds nothing serious on the page of two rehearsals'() {
    const page = await open(join(samples, 'compared/go-no-go.html'), { bypassCSP: true });
    await page.evaluate(() => { for (const d of document.querySelectorAll('details')) d.open = true; });
    await page.evaluate(axe);
    const found = await page.evaluate(() => axe.run());
    assert.deepEqual(found.violations.filter((v) => ['serious', 'critical'].includes(v.impact)).map((v) => v.id + ': ' + v.nodes[0].target), []);
    await page.context().close();
  },
  async 'names and comments stay text'() {
    const page = await open('hostile', { flat: true });
    assert.equal(await page.evaluate(() => window.evil), undefined);
    assert.match(await page.textContent('.program'), /<\/script><script>/);
    assert.deepEqual(page.faults, []);
    await page.context().close();
  },
  async 'a damaged record is said in a sentence'() {
    const whole = readFileSync(join(samples, 'go/report.html'), 'utf8');
    const [head, rest] = whole.split('id="record">'), end = rest.indexOf('</script>');
    const record = JSON.parse(rest.slice(0, end));
    const variants = {
      'cut short': [rest.slice(0, 5000), /damaged/],
      'of another version': [JSON.stringify({ ...record, schema: 'understudy.report/9' }), /understudy.report\/9/],
      'with a broken replay': [JSON.stringify({ ...record, replay: { ...record.replay, path: { ...record.replay.path, time_s: { unit: 1, data: 'AAAA' } } } }), /replay is left out/],
      'without a replay': [JSON.stringify({ ...record, replay: undefined }), /written without it/],
      'with nulls in the trace': [JSON.stringify({ ...record, trace: { ...record.trace, columns: { ...record.trace.columns, gap_mm: record.trace.columns.gap_mm.map(() => null) } } }), /Curves/],
    };
    for (const [name, [data, words]] of Object.entries(variants)) {
      const file = join(samples, 'damaged.html');
      writeFileSync(file, head + 'id="record">' + data.replace(/</g, '\\u003c') + rest.slice(end));
      const page = await open(file, { flat: name !== 'with a broken replay' });
      assert.match(await page.textContent('#page'), words, name);
      assert.deepEqual(page.faults.filter((fault) => !/invalid zlib|Error/.test(fault)), [], name);
      await page.context().close();
    }
  },
  async '50 000 moves are below 5 MB and open in three seconds of script'() {
    const size = statSync(join(samples, 'large/report.html')).size;
    const page = await open('large');
    const { metrics } = await page.session.send('Performance.getMetrics');
    const metric = (name) => metrics.find((m) => m.name === name).value;
    const seconds = metric('ScriptDuration'), heap = metric('JSHeapUsedSize') / 1e6;
    const scrub = await page.evaluate(() => {
      const node = document.querySelector('.scrub');
      const began = performance.now();
      for (let i = 0; i < 50; ++i) { node.value = i * Number(node.max) / 50; node.dispatchEvent(new Event('input')); }
      return (performance.now() - began) / 50;
    });
    console.log(`   ${(size / 1e6).toFixed(2)} MB, ${seconds.toFixed(2)} s of script, ${heap.toFixed(0)} MB of heap, ${scrub.toFixed(1)} ms of script a scrub`);
    assert.ok(size < 5e6, size + ' bytes');
    assert.ok(seconds < 3, seconds + ' s');
    assert.ok(heap < 500 && scrub < 50);
    assert.match(await page.textContent('.replay .note'), /beads, drawn to within/);
    await page.context().close();
  },
};
const millionTests = {
  async 'a million moves open, and the page says how much it leaves out'() {
    const size = statSync(join(samples, 'large/report.html')).size;
    const page = await open('large');
    const { metrics } = await page.session.send('Performance.getMetrics');
    const heap = metrics.find((m) => m.name === 'JSHeapUsedSize').value / 1e6;
    console.log(`   ${(size / 1e6).toFixed(2)} MB, ${heap.toFixed(0)} MB of heap`);
    assert.ok(size < 5e6 && heap < 500);
    assert.deepEqual(page.faults, []);
    const notes = (await page.$$eval('.note', (nodes) => nodes.map((node) => node.textContent))).join(' ');
    assert.match(notes, /999\s999\sbeads, drawn to within\s[\d.]+\s.m; one stretch of\s\d+\sis drawn, the others are left out; the path is thinned to\s25\s000\sinstants/);
    assert.match(notes, /The last\s\d+\skB of the program are left out/);
    const last = await page.$eval('.scrub', (node) => { node.value = node.max; node.dispatchEvent(new Event('input')); return Number(node.max); });
    assert.ok(Math.abs(last - 50000) < 1, 'the replay goes to the end of the print: ' + last);
    await page.context().close();
  },
};
const plainTests = {
  async 'the plain page says what it is, and the answer'() {
    for (const name of ['go', 'no-go', 'stopped', 'hostile']) {
      const page = await open(name);
      assert.match(await page.textContent('.warn-note'), /built without npm/);
      assert.equal(await page.evaluate(() => window.evil), undefined);
      assert.deepEqual(page.faults, [], name);
      await page.context().close();
    }
  },
};

let failed = 0;
const only = process.argv[6];
for (const [name, test] of Object.entries({ plain: plainTests, million: millionTests }[kind] ?? tests)) {
  if (only && !name.includes(only)) continue;
  const began = Date.now();
  try {
    await test();
    console.log(`ok   ${name} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
  } catch (error) {
    ++failed;
    console.log(`FAIL ${name}: ${error.message}`);
  }
}
await browser.close();
process.exit(failed ? 1 : 0);
