// usage: node gltf_test.mjs WEB UNDERSTUDY RUN...: WEB holds node_modules; each RUN is a folder of results of a nominal machine, and RUN.glb
// what was exported from it. What is compared with comes from trace.csv, summary.json and `understudy poses`.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { basename, join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { inflateSync } from 'node:zlib';

const [web, understudy, ...runs] = process.argv.slice(2);
const modules = join(web, 'node_modules');
for (const name of ['gltf-validator', 'three'])
  if (!existsSync(join(modules, name))) {
    console.log('skipped: the package ' + name + ' of web/package.json is not there');
    process.exit(77);
  }
const { validateBytes } = createRequire(pathToFileURL(join(web, 'package.json')))('gltf-validator');
const three = await import(pathToFileURL(join(modules, 'three/build/three.module.js')));
const { GLTFLoader } = await import(pathToFileURL(join(modules, 'three/examples/jsm/loaders/GLTFLoader.js')));

const bytesOf = (run) => new Uint8Array(readFileSync(run + '.glb'));

function table(text) {
  const [head, ...rows] = text.trim().split('\n').map((line) => line.split(','));
  return rows.map((row) => Object.fromEntries(head.map((name, i) => [name, row[i]])));
}

/** The scene as three.js plays it, in W: metres, and a function that puts it to an instant. */
async function play(run) {
  const bytes = bytesOf(run);
  const gltf = await new GLTFLoader().parseAsync(bytes.buffer, '');
  const mixer = new three.AnimationMixer(gltf.scene);
  assert.equal(gltf.animations.length, 1);
  const action = mixer.clipAction(gltf.animations[0]);
  action.setLoop(three.LoopOnce);
  action.clampWhenFinished = true;
  action.play();
  const node = (name) => {
    const found = gltf.scene.getObjectByName(three.PropertyBinding.sanitizeNodeName(name));
    assert.ok(found, run + ' has no node ' + name);
    return found;
  };
  const at = (time) => {
    action.reset();  // it stops at the end
    mixer.setTime(Math.min(time, gltf.animations[0].duration));
    gltf.scene.updateMatrixWorld(true);
  };
  /** The pose of a node in another. */
  const pose = (name, frame) => {
    const matrix = new three.Matrix4().multiplyMatrices(node(frame).matrixWorld.clone().invert(), node(name).matrixWorld);
    const place = new three.Vector3(), turn = new three.Quaternion();
    matrix.decompose(place, turn, new three.Vector3());
    return { place, turn };
  };
  const beads = () => node('beads').children;
  return { gltf, node, at, pose, beads };
}

/** A column of the data block, as docs/report-data.md has it. */
function unpack(column) {
  const [data, unit] = typeof column === 'string' ? [column, 1] : [column.data, column.unit], values = [];
  let last = 0, rest = 0, scale = 1;
  for (const byte of inflateSync(Buffer.from(data, 'base64'))) {
    rest += (byte & 127) * scale;
    scale *= 128;
    if (byte > 127) continue;
    last += rest % 2 ? -(rest + 1) / 2 : rest / 2;
    values.push(last * unit);
    rest = 0;
    scale = 1;
  }
  return values;
}

/** Of the round ends of all stretches, which overlap with what is beside them [mm3]. */
function volumeOfEnds(run) {
  const page = readFileSync(join(run, 'report.html'), 'utf8'), from = page.indexOf('id="record">') + 12;
  const { beads } = JSON.parse(page.slice(from, page.indexOf('</script>', from))).replay;
  const width = unpack(beads.width_mm), height = unpack(beads.height_mm);
  const half = (i) => Math.PI * height[i] ** 3 / 12 + Math.PI * height[i] ** 2 / 8 * (width[i] - height[i]);
  let i = 0, ends = 0;
  for (const count of unpack(beads.stretches)) {
    ends += half(i) + half(i + count - 1);
    i += count;
  }
  return ends;
}

/** Of a closed mesh, by the divergence theorem [m^3]. */
function volume(mesh) {
  const p = mesh.geometry.getAttribute('position'), index = mesh.geometry.index;
  let six = 0;
  const [a, b, c] = [0, 1, 2].map(() => new three.Vector3());
  for (let t = 0; t < index.count; t += 3) {
    [a, b, c].forEach((v, k) => v.fromBufferAttribute(p, index.getX(t + k)));
    six += a.clone().cross(b).dot(c);
  }
  return six / 6;
}

const tests = {
  async 'the validator of Khronos finds neither error nor warning'(run) {
    const report = await validateBytes(bytesOf(run), { maxIssues: 20 });
    assert.equal(report.info.version, '2.0');
    const { numErrors, numWarnings, messages } = report.issues;
    assert.equal(numErrors + numWarnings, 0, JSON.stringify(messages.filter((m) => m.severity < 2), null, 1));
  },
  // 5 um of the record's path, 10 um of the file's bound, 1 um of the page's rounding; between two rows of the trace, 2 ms, nothing bends.
  async 'the tool stands where the trace has it'(run) {
    const scene = await play(run);
    const trace = table(readFileSync(join(run, 'trace.csv'), 'utf8'));
    for (let n = 0; n < 60; ++n) {
      const row = trace[Math.floor(n * (trace.length - 1) / 59)];
      scene.at(Number(row.time_s));
      const { place, turn } = scene.pose('tool', 'work');
      const truth = new three.Vector3(row.x_mm / 1000, row.y_mm / 1000, row.z_mm / 1000);
      assert.ok(place.distanceTo(truth) < 20e-6, row.time_s + ' s: ' + 1e6 * place.distanceTo(truth) + ' um');
      const angle = turn.angleTo(new three.Quaternion(Number(row.qx), Number(row.qy), Number(row.qz), Number(row.qw)));
      assert.ok(angle < 2e-3, row.time_s + ' s: ' + angle + ' rad');
    }
  },
  // A nominal machine differs from its description by play alone: 75 um in a strut of the hexapod, less on the others.
  async 'the tool stands where the axes put it'(run) {
    const trace = table(readFileSync(join(run, 'trace.csv'), 'utf8'));
    const machine = JSON.parse(readFileSync(join(run, 'summary.json'), 'utf8')).provenance.command.match(/--machine (\S+)/)?.[1] ?? 'hexapod';
    const columns = Object.keys(trace[0]).slice(Object.keys(trace[0]).indexOf('path_mm') + 1);
    const rows = [0.2, 0.5, 0.9].map((share) => trace[Math.floor(share * (trace.length - 1))]);
    const csv = [columns.map((c) => c.replace('axis_', '')), ...rows.map((row) => columns.map((c) => row[c]))].map((line) => line.join(',')).join('\n');
    const poses = table(execFileSync(understudy, ['poses', '--machine', machine], { input: csv + '\n', encoding: 'utf8' }));
    const scene = await play(run);
    rows.forEach((row, i) => {
      scene.at(Number(row.time_s));
      const off = scene.pose('tool', 'work').place.distanceTo(new three.Vector3(poses[i].x_mm / 1000, poses[i].y_mm / 1000, poses[i].z_mm / 1000));
      assert.ok(off < 100e-6, row.time_s + ' s: ' + 1e6 * off + ' um');
    });
  },
  async 'metres, y up: what lies on the table is above it'(run) {
    const scene = await play(run);
    scene.at(1e9);
    const box = new three.Box3().setFromObject(scene.node('beads')), table = new three.Box3().setFromObject(scene.node('table'));
    assert.ok(box.max.y > table.getCenter(new three.Vector3()).y);
    assert.ok(box.max.distanceTo(box.min) < 0.5 && box.max.distanceTo(box.min) > 1e-3, 'metres');
  },
  async 'beads appear slice by slice, each when it is laid and not before'(run) {
    const scene = await play(run);
    const trace = table(readFileSync(join(run, 'trace.csv'), 'utf8'));
    const shown = () => scene.beads().filter((bead) => bead.scale.x > 0);
    const end = Number(trace.at(-1).time_s);
    let before = 0;
    for (let n = 0; n <= 20; ++n) {
      const time = end * n / 20;
      scene.at(time);
      const now = shown();
      assert.ok(now.length >= before);
      before = now.length;
      const printed = trace.filter((row) => row.time_s <= time + 0.05 && row.extruding === '1');
      if (!printed.length) assert.equal(now.length, 0, 'at ' + time + ' s nothing was extruded');
      // All that is seen is near where the tip has been.
      const vertices = now.length ? now.at(-1).geometry.getAttribute('position') : { count: 0 };
      for (let v = 0; v < vertices.count; v += 37) {
        const vertex = new three.Vector3().fromBufferAttribute(vertices, v);
        const nearest = Math.min(...printed.map((row) => vertex.distanceTo(new three.Vector3(row.x_mm / 1000, row.y_mm / 1000, row.z_mm / 1000))));
        assert.ok(nearest < 1.5e-3, 'at ' + time + ' s a vertex is ' + nearest + ' m from where the tip has been');  // beads of 2 mm at a start
      }
    }
    scene.at(end + 1);
    assert.equal(shown().length, scene.beads().length);
    scene.at(0);
    assert.equal(shown().length, 0);
  },
  // Faces lie inside the round sides: 12 sides lose 4.5 % of a circle, and a section is a third of one at most. The record's sections, which
  // stand for many beads each, and its micrometres are 1 % off.
  async 'the beads have the volume of the filament that was laid, and of their round ends'(run) {
    const scene = await play(run);
    const print = JSON.parse(readFileSync(join(run, 'summary.json'), 'utf8')).print;
    const filament = print.printed_mm * Math.PI / 4 * 1.75 ** 2, ends = volumeOfEnds(run);
    const laid = 1e9 * scene.beads().reduce((sum, bead) => sum + volume(bead), 0);
    console.log(`     ${laid.toFixed(3)} mm3 of beads, ${filament.toFixed(3)} mm3 of filament, ${ends.toFixed(3)} mm3 of ends`);
    assert.ok(Math.abs(laid - ends - filament) < 0.03 * (filament + ends));
  },
};

let failed = 0;
for (const run of runs)
  for (const [name, test] of Object.entries(tests)) {
    try {
      await test(run);
      console.log('ok   ' + basename(run) + ': ' + name);
    } catch (error) {
      ++failed;
      console.log('FAIL ' + basename(run) + ': ' + name + ': ' + error.message);
    }
  }
process.exit(failed ? 1 : 0);
