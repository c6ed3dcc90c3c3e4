// What the colour of a bead can say, and the key to it.
import { aboutBand, cividis, css, kKinds, kPlastic, kUnknown, type Rgb } from './colours';
import { element } from './elements';
import { format } from './format';
import type { Sections } from './beads';
import type { Report } from './record';
import type { Run } from './run';

export interface Mode { name: string; label: string; colour: (section: number) => Rgb; legend: () => Node; text: (section: number) => string }

function ramp(from: string, to: string, colour: (share: number) => Rgb): Node {
  const stops = Array.from({ length: 11 }, (_, i) => css(colour(i / 10)) + ' ' + 10 * i + '%').join(', ');
  return element('span', { class: 'key-line' }, from, element('span', { class: 'ramp', style: 'background: linear-gradient(90deg, ' + stops + ')' }), to);
}

function swatches(pairs: [string, Rgb][]): Node {
  return element('span', { class: 'key-line' }, ...pairs.map(([label, colour]) =>
    element('span', { class: 'swatch' }, element('i', { style: 'background: ' + css(colour) }), label)));
}

/** Of values that count from zero upwards, by cividis up to `top`. */
function upwards(name: string, label: string, values: (section: number) => number, top: number, unit: string, topLabel = ''): Mode {
  return {
    name, label, colour: (s) => (isFinite(values(s)) ? cividis(values(s) / top) : kUnknown),
    legend: () => ramp(format.quantity(0, unit), (topLabel || 'to ') + format.quantity(top, unit), cividis), text: (s) => format.quantity(values(s), unit),
  };
}

function quantile(count: number, values: (i: number) => number, share: number): number {
  const sorted = Array.from({ length: count }, (_, i) => values(i)).filter(isFinite).sort((a, b) => a - b);
  return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] : 1;
}

export function modesOf(report: Report, run: Run, sections: Sections, typeNames: string[]): Mode[] {
  const along = (values: Float64Array) => {
    const at = Float32Array.from(sections.time, (t) => run.valueAt(values, t - 1e-3));
    return (s: number) => at[s];
  };
  const speed = new Float32Array(sections.count);
  for (let s = 0; s + 1 < sections.first.length; ++s)
    for (let i = sections.first[s]; i < sections.first[s + 1]; ++i) {
      const [a, b] = i > sections.first[s] ? [i - 1, i] : [i, Math.min(i + 1, sections.first[s + 1] - 1)];
      const took = sections.time[b] - sections.time[a], p = sections.at;
      speed[i] = took > 0 ? Math.hypot(p[3 * b] - p[3 * a], p[3 * b + 1] - p[3 * a + 1], p[3 * b + 2] - p[3 * a + 2]) / took : NaN;
    }
  const modes: Mode[] = [];
  const band = report.gap_band;
  if (band) {
    const gap = along(run.gap);
    modes.push({
      name: 'gap', label: 'Gap', colour: (s) => (isFinite(gap(s)) ? aboutBand(gap(s) / 1000, band.min_mm, band.max_mm) : kUnknown),
      legend: () => ramp('too near', 'too far; grey: ' + format.range(band.min_mm, band.max_mm, 'mm'), (share) =>
        aboutBand(band.min_mm + (3 * share - 1) * (band.max_mm - band.min_mm), band.min_mm, band.max_mm)),
      text: (s) => format.quantity(gap(s) / 1000, 'mm'),
    });
  }
  const accepted = report.summary.accuracy && report.summary.accuracy.tip_tolerance_mm;
  const tip = along(run.tipError);
  modes.push(upwards('tip', 'Tip error', tip, accepted ? 1000 * accepted : quantile(sections.count, tip, 0.99) || 1, 'um', accepted ? 'accepted ' : ''));
  const turn = along(run.turnError);
  modes.push(upwards('turn', 'Orientation error', turn, quantile(sections.count, turn, 0.99) || 1, 'mrad'));
  const s = (i: number) => speed[i];
  modes.push(upwards('speed', 'Speed', s, quantile(sections.count, s, 0.99) || 1, 'mm/s'));
  const wide = (i: number) => sections.width[i];
  modes.push(upwards('width', 'Width of the bead', wide, quantile(sections.count, wide, 0.999) || 1, 'mm'));
  const begin = sections.time[0], end = sections.time[sections.count - 1] || 1;
  modes.push({ name: 'order', label: 'When it was laid', colour: (i) => cividis((sections.time[i] - begin) / (end - begin || 1)),
    legend: () => ramp('first', 'last', cividis), text: (i) => format.quantity(sections.time[i], 's') });
  if (sections.type && typeNames.length > 1) {
    const ofSection = sections.type;
    const colour = (type: number): Rgb => kKinds[type === 0 ? 0 : 1 + (type - 1) % (kKinds.length - 1)];
    modes.push({ name: 'type', label: 'Feature type', colour: (i) => colour(ofSection[i]),
      legend: () => swatches(typeNames.map((name, i): [string, Rgb] => [name || 'none stated', colour(i)])), text: (i) => typeNames[ofSection[i]] || 'none stated' });
  }
  modes.push({ name: 'plain', label: 'Plain', colour: () => kPlastic, legend: () => element('span', {}), text: () => '' });
  return modes;
}
