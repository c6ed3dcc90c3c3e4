// Bundles the page: node build.mjs SOURCE OUT, with node_modules beside this file. Writes into OUT report.js, plots.css, notices.txt (the
// licences of what is bundled) and packages.json (what that is).
import { build } from 'esbuild';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const [source = '.', out = 'dist'] = process.argv.slice(2);
const modules = join(dirname(fileURLToPath(import.meta.url)), 'node_modules');
mkdirSync(out, { recursive: true });
const result = await build({
  entryPoints: [join(source, 'report/src/main.ts')], bundle: true, minify: true, format: 'iife', target: 'es2020', legalComments: 'none', charset: 'ascii',
  metafile: true, write: false, outfile: 'report.js', nodePaths: [modules], logLevel: 'warning',
});
// It stands inside <script>, where only these two would end or bend it.
const script = result.outputFiles[0].text.replace(/<\/(script)/gi, '<\\/$1').replace(/<!--/g, '<\\!--');
const names = [...new Set(Object.keys(result.metafile.inputs).flatMap((file) => /node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(file)?.[1] ?? []))].sort();
const packages = names.map((name) => {
  const { version, license } = JSON.parse(readFileSync(join(modules, name, 'package.json'), 'utf8'));
  return { name, version, license };
});
const notices = packages.map(({ name, version }) => name + ' ' + version + '\n\n' + readFileSync(join(modules, name, 'LICENSE'), 'utf8').trim() + '\n');
writeFileSync(join(out, 'report.js'), script);
writeFileSync(join(out, 'plots.css'), readFileSync(join(modules, 'uplot/dist/uPlot.min.css')));
writeFileSync(join(out, 'packages.json'), JSON.stringify(packages, null, 1) + '\n');
// They stand inside an HTML comment, where "--" is a fault.
writeFileSync(join(out, 'notices.txt'), notices.join('\n').replace(/--+/g, '-'));
