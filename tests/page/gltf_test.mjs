// usage: node gltf_test.mjs WEB UNDERSTUDY RUN...: WEB holds node_modules; each RUN is a folder of results, and RUN.glb what was exported
// from it. RUN/beads.txt is not needed: what is compared with comes from trace.csv, summary.json and `understudy poses`.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { basename, join } from 'node:path';
import { pathToFileURL } from 'node:url';

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
  // The nominal machine differs from its description by play alone.
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
      assert.ok(off < 60e-6, row.time_s + ' s: ' + 1e6 * off + ' um');
    });
  },
  async 'metres, y up: what lies on the table is above it'(run) {
    const scene = await play(run);
    scene.at(1e9);
    const { beads } = { beads: scene.node('beads') };
    const box = new three.Box3().setFromObject(beads), table = new three.Box3().setFromObject(scene.node('table'));
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
      for (const bead of now.slice(-1)) {
        bead.geometry.computeBoundingBox();
        const middle = bead.geometry.boundingBox.getCenter(new three.Vector3());
        const nearest = Math.min(...printed.map((row) => middle.distanceTo(new three.Vector3(row.x_mm / 1000, row.y_mm / 1000, row.z_mm / 1000))));
        assert.ok(nearest < 3e-3, nearest + ' m from the path');
      }
    }
    scene.at(end + 1);
    assert.equal(shown().length, scene.beads().length);
    scene.at(0);
    assert.equal(shown().length, 0);
  },
};

// Of rehearsals: made-up records state no filament.
const rehearsed = {
  // Faces lie inside the round sides by some 1 % of the section, and each bead's round ends are in addition to its length.
  async 'the beads have the volume of the filament that was laid'(run) {
    const scene = await play(run);
    const print = JSON.parse(readFileSync(join(run, 'summary.json'), 'utf8')).print;
    const filament = print.printed_mm * Math.PI / 4 * 1.75 ** 2;
    const laid = 1e9 * scene.beads().reduce((sum, bead) => sum + volume(bead), 0);
    console.log('     ' + laid.toFixed(3) + ' mm3 of beads, ' + filament.toFixed(3) + ' mm3 of filament');
    assert.ok(Math.abs(laid / filament - 1) < 0.03, laid + ' mm3 of ' + filament);
  },
};

let failed = 0;
for (const run of runs)
  for (const [name, test] of Object.entries({ ...tests, ...rehearsed })) {
    try {
      await test(run);
      console.log('ok   ' + basename(run) + ': ' + name);
    } catch (error) {
      ++failed;
      console.log('FAIL ' + basename(run) + ': ' + name + ': ' + error.message);
    }
  }
process.exit(failed ? 1 : 0);
