// Beads as one mesh: stadium-shaped sections swept from one to the next, ends rounded (sim/surface/bead_sweep.h does the same for pictures).
import type { BeadData } from './record';
import { unpackColumn, unpackIntegers } from './pack';

export interface Sections {
  first: Uint32Array;  // of each stretch, and the count of all at the end
  type: Float64Array | null;  // of each section
  at: Float32Array; up: Float32Array;  // x y z of each section
  width: Float32Array; height: Float32Array; time: Float32Array; line: Float64Array;
  count: number;
}

export function readSections(data: BeadData): Sections {
  const sizes = unpackIntegers(data.stretches);
  const first = new Uint32Array(sizes.length + 1);
  sizes.forEach((size, s) => { first[s + 1] = first[s] + size; });
  const count = first[sizes.length];
  const three = (columns: Float64Array[]) => {
    const all = new Float32Array(3 * count);
    columns.forEach((column, c) => { for (let i = 0; i < count; ++i) all[3 * i + c] = column[i]; });
    return all;
  };
  return {
    first, count, type: data.type ? unpackIntegers(data.type) : null,
    at: three([data.x_mm, data.y_mm, data.z_mm].map(unpackColumn)), up: three([data.up_x, data.up_y, data.up_z].map(unpackColumn)),
    width: Float32Array.from(unpackColumn(data.width_mm)), height: Float32Array.from(unpackColumn(data.height_mm)),
    time: Float32Array.from(unpackColumn(data.time_s)), line: unpackIntegers(data.line),
  };
}

export interface BeadMesh {
  position: Float32Array; normal: Int8Array; time: Float32Array;
  section: Uint32Array;  // of each vertex
  index: Uint32Array;
}

/** Sides of a full turn by how much there is to draw. */
export function sidesFor(sections: number): number { return sections > 25000 ? 4 : sections > 8000 ? 8 : 16; }

export function sweep(sections: Sections, sides: number): BeadMesh {
  const around = sides + 2, caps = sides / 4, stretches = sections.first.length - 1;
  // A blob is swept, too: over a thousandth of its height.
  let rings = 0;
  for (let s = 0; s < stretches; ++s) rings += Math.max(2, sections.first[s + 1] - sections.first[s]) + 2 * caps;
  const vertices = rings * around;
  const mesh: BeadMesh = {
    position: new Float32Array(3 * vertices), normal: new Int8Array(3 * vertices), time: new Float32Array(vertices), section: new Uint32Array(vertices),
    index: new Uint32Array(6 * (rings - stretches) * around + 6 * stretches * (around - 2)),
  };
  const circle = new Float64Array(2 * around);
  for (const half of [0, 1])
    for (let k = 0; k <= sides / 2; ++k) {
      const angle = Math.PI * (k / (sides / 2) - 0.5), sign = half ? -1 : 1;
      circle[2 * (half * (sides / 2 + 1) + k)] = sign * Math.cos(angle);
      circle[2 * (half * (sides / 2 + 1) + k) + 1] = sign * Math.sin(angle);
    }
  let v = 0, n = 0;
  const along = [0, 0, 0], side = [0, 0, 0], up = [0, 0, 0];
  const direction = (a: number, b: number): [number, number, number] => {
    const { at } = sections;
    const d: [number, number, number] = [at[3 * b] - at[3 * a], at[3 * b + 1] - at[3 * a + 1], at[3 * b + 2] - at[3 * a + 2]];
    const length = Math.hypot(...d);
    return length > 0 ? [d[0] / length, d[1] / length, d[2] / length] : [0, 0, 0];
  };
  const frame = (i: number, begin: number, end: number) => {
    const before = i > begin ? direction(i - 1, i) : [0, 0, 0], after = i + 1 < end ? direction(i, i + 1) : [0, 0, 0];
    let length = 0;
    for (let c = 0; c < 3; ++c) along[c] = before[c] + after[c];
    length = Math.hypot(along[0], along[1], along[2]);
    const u = [sections.up[3 * i], sections.up[3 * i + 1], sections.up[3 * i + 2]];
    if (!(length > 0)) { along[0] = u[2] ** 2 < 0.8 ? 0 : 1; along[1] = 0; along[2] = along[0] ? 0 : 1; length = 1; }
    for (let c = 0; c < 3; ++c) along[c] /= length;
    cross(along, u, side);
    let size = Math.hypot(side[0], side[1], side[2]);
    if (size < 1e-4) { cross(along, Math.abs(along[0]) < 0.7 ? [1, 0, 0] : [0, 1, 0], side); size = Math.hypot(side[0], side[1], side[2]); }
    for (let c = 0; c < 3; ++c) side[c] /= size;
    cross(side, along, up);
  };
  const ring = (i: number, latitude: number, shift: number) => {
    const radius = 0.5 * sections.height[i], flat = Math.max(0, 0.5 * (sections.width[i] - sections.height[i]));
    const out = radius * Math.cos(latitude), ahead = radius * Math.sin(latitude) + shift, cosine = Math.cos(latitude), sine = Math.sin(latitude);
    for (let k = 0; k < around; ++k) {
      const x = circle[2 * k], y = circle[2 * k + 1], edge = k <= sides / 2 ? flat : -flat;
      for (let c = 0; c < 3; ++c) {
        mesh.position[3 * v + c] = sections.at[3 * i + c] + ahead * along[c] + (edge + out * x) * side[c] + out * y * up[c];
        mesh.normal[3 * v + c] = Math.round(127 * (cosine * (x * side[c] + y * up[c]) + sine * along[c]));
      }
      mesh.time[v] = sections.time[i];
      mesh.section[v++] = i;
    }
  };
  for (let s = 0; s < stretches; ++s) {
    const begin = sections.first[s], end = sections.first[s + 1], firstVertex = v, blob = end - begin === 1;
    for (let i = begin; i < end; ++i) {
      frame(i, begin, end);
      if (i === begin) for (let step = caps; step > 0; --step) ring(i, -latitude(step, caps), 0);
      ring(i, 0, 0);
      if (blob) ring(i, 0, 1e-3 * sections.height[i]);
      if (i + 1 === end) for (let step = 1; step <= caps; ++step) ring(i, latitude(step, caps), 0);
    }
    const here = (v - firstVertex) / around;
    for (let r = 0; r + 1 < here; ++r)
      for (let k = 0; k < around; ++k) {
        const a = firstVertex + r * around + k, b = firstVertex + r * around + (k + 1) % around;
        mesh.index.set([a, b + around, b, a, a + around, b + around], n);
        n += 6;
      }
    const last = v - around;
    for (let k = 1; k + 1 < around; ++k) {
      mesh.index.set([firstVertex, firstVertex + k, firstVertex + k + 1, last, last + k + 1, last + k], n);
      n += 6;
    }
  }
  return mesh;
}

// A cap ends in a small ring instead of a point.
function latitude(step: number, caps: number): number { return 0.5 * Math.PI * Math.min(step / caps, 0.98); }

function cross(a: ArrayLike<number>, b: ArrayLike<number>, out: number[]) {
  const x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
  out[0] = x; out[1] = y; out[2] = z;
}
