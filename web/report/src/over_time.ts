// Curves of what the run's record keeps by stretches of time: loads of the drives, temperatures, clearance of the nozzle. A record without
// one of them has no such curve.
import { beyondNote, kAxisColours, nearlyAll, type Chart, type Curve } from './chart';
import { styleColour } from './colours';
import { format } from './format';
import { unpackColumn, unpackIntegers } from './pack';
import type { OverTime, Report, SpanColumns } from './record';

type Values = (number | null | undefined)[];

/** Two instants a stretch, so that its least and its most both have a place. */
function instants(data: OverTime): number[] {
  const begin = unpackColumn(data.begin_s), end = unpackColumn(data.end_s);
  return Array.from(begin).flatMap((at, i) => [at, 0.5 * (at + Math.max(at, end[i]))]);
}

/** The least and the most of each stretch, the one first that is nearer to what was before. `missing`: null breaks, undefined bridges. */
function ends(span: SpanColumns, missing: null | undefined): Values {
  const low = unpackColumn(span.low), high = unpackColumn(span.high);
  const values: Values = [];
  let last = NaN;
  for (let i = 0; i < low.length; ++i) {
    if (isNaN(low[i])) { values.push(missing, missing); continue; }
    const up = !(Math.abs(high[i] - last) < Math.abs(low[i] - last));
    values.push(up ? low[i] : high[i], up ? high[i] : low[i]);
    last = up ? high[i] : low[i];
  }
  return values;
}

function name(axis: string): string { return axis.replace(/^axis_/, '').replace(/_[a-z]+$/, ''); }

function forces(data: OverTime, x: number[]): Chart[] {
  if (!data.drives) return [];
  const units = [...new Set(data.drives.map((drive) => drive.unit))];
  return units.map((unit) => {
    const drives = data.drives!.filter((drive) => drive.unit === unit), struts = drives.every((drive) => /^l\d/.test(drive.axis));
    const curves: Curve[] = drives.map((drive, i) => ({ label: name(drive.axis), colour: styleColour(kAxisColours[i % 8]), dash: i % 2 ? [6, 3] : undefined,
      x, y: ends(drive, null) }));
    const { range, beyond } = nearlyAll(curves, [0]);
    const shown = unit.replace(' ', '\u00a0');
    const flips = struts && data.flips ? data.flips : null;
    const count = flips ? flips.count : 0;
    const times = flips ? unpackColumn(flips.time_s) : [], axes = flips ? unpackIntegers(flips.axis) : [];
    return { title: struts ? 'Strut forces' : unit === 'N' ? 'Forces of the drives' : 'Torques of the drives', curves, unit: shown, decimals: 2,
      xLabel: 'time (s)', yLabel: (struts ? 'push of the strut (' : unit === 'N' ? 'force (' : 'torque (') + shown + ')', range,
      lines: [{ at: 0, colour: styleColour('ink'), dash: [] }], ticks: Array.from(times, (time, i) => ({ time, colour: styleColour(kAxisColours[axes[i] % 8]) })),
      note: 'What the engine says that each drive carried' + (struts ? '; above zero the strut pushes, below it pulls. ' + (count ? format.plural(count, 'flip')
        + ': the load changes its side, and the strut falls across its play. Ticks at the foot, in the colour of the strut'
        + (count > times.length ? '; the first ' + format.count(times.length) + ' are drawn.' : '.') : 'No load changes its side: no play flips.') : '.')
        + beyondNote(beyond) };
  });
}

function temperature(data: OverTime, x: number[]): Chart | null {
  const curves: Curve[] = [];
  if (data.nozzle_c) curves.push({ label: 'nozzle', colour: styleColour('curve-2'), dash: [6, 3], x, y: ends(data.nozzle_c, null) });
  if (data.interface_c) curves.push({ label: 'bead on bead', colour: styleColour('with'), x, y: ends(data.interface_c, null) });
  if (!curves.length) return null;
  // A scale of 10 K at least: the steps of the record are 0.1 K.
  const first = curves[0].y.find((y): y is number => typeof y === 'number' && isFinite(y)) ?? 0;
  const glass = data.glass_transition_c, { range } = nearlyAll(curves, [first - 5, first + 5, ...(glass === undefined ? [] : [glass - 10])]);
  return { title: 'Temperature', curves, unit: '°C', decimals: 1, xLabel: 'time (s)', yLabel: 'temperature (°C)', range,
    lines: glass === undefined ? [] : [{ at: glass, colour: styleColour('limit'), dash: [6, 4] }],
    note: 'Of the nozzle' + (data.interface_c ? ', and where a bead meets the one that it is laid on' + (glass === undefined ? '.'
      : '. Long dashes: the glass transition, ' + format.number(glass, 0) + '\u00a0°C; below it beads do not weld.') : '; no bead was laid on another.') };
}

function clearance(data: OverTime, x: number[], report: Report): Chart | null {
  if (!data.nozzle_clearance_mm) return null;
  const least = unpackColumn(data.nozzle_clearance_mm);
  const curves: Curve[] = [{ label: 'nozzle', colour: styleColour('with'), x, y: Array.from(least).flatMap((v) => (isNaN(v) ? [undefined, undefined] : [v, undefined])) }];
  const { range, beyond } = nearlyAll(curves, [0]);
  const to = report.names.fixture ? 'the part' : 'the table';
  return { title: 'Clearance of the nozzle', curves, unit: 'mm', decimals: 3, xLabel: 'time (s)', yLabel: 'clearance (mm)', range,
    lines: [{ at: 0, colour: styleColour('limit'), dash: [6, 4] }],
    note: 'Least distance of any point of the nozzle to ' + to + '; below zero, how deep it is inside. It is measured as often as a contact could come about, and '
      + 'straight lines lie between.' + beyondNote(beyond) };
}

export function chartsOverTime(report: Report): Chart[] {
  const data = report.over_time;
  if (!data) return [];
  const x = instants(data);
  return [clearance(data, x, report), temperature(data, x), ...forces(data, x)].filter((chart): chart is Chart => chart !== null);
}
