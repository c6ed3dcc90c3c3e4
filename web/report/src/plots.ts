// Curves over time and along the path, with the instant of the replay on each; a press moves the replay there.
import uPlot from 'uplot';
import { beyondNote, kAxisColours, nearlyAll, type Chart, type Curve } from './chart';
import { element } from './elements';
import { format } from './format';
import { styleColour } from './colours';
import { chartsOverTime } from './over_time';
import { lastNotAbove } from './pack';
import type { Clock } from './clock';
import type { Finding, Numbers, Report, Trace } from './record';

export function drawPlots(report: Report, clock: Clock | null, calibrationTable: () => Node | null): HTMLElement | null {
  if (!report.trace) {
    if (report.summary.print) return null;
    return element('section', {}, element('h2', {}, 'The run'), element('p', {}, 'The program was not run: there are no curves, and no figures of print, accuracy or gap.'));
  }
  const node = element('section', { class: 'plots', 'aria-label': 'Curves' });
  const build = () => {
    const trace = report.trace!;
    node.replaceChildren(element('h2', {}, 'Curves'), element('p', { class: 'note' }, (clock ? 'The upright line is the instant of the replay: press a curve to move it. ' : '')
      + 'Drag to enlarge, press twice to see all.'));
    const grid = element('div', { class: 'plot-grid' });
    node.append(grid);
    for (const chart of [calibration(report, calibrationTable), gap(report), tip(report), orientation(report), speed(trace), ...chartsOverTime(report), profile(report),
      ...axes(report)]) {
      if (!chart) continue;
      const host = element('div', { class: 'chart' });
      grid.append(element('figure', {}, element('figcaption', {}, element('b', {}, chart.title), ' ', chart.note), chart.before || null, host));
      plot(report, trace, chart, host, clock);
    }
  };
  build();
  document.addEventListener('understudy-theme', build);
  return node;
}

/** Along what was extruded; null breaks the curve where extrusion paused or nothing lies below. */
function alongPath(trace: Trace, column: string): { x: number[]; y: (number | null)[] } {
  const { extruding, path_mm: path, [column]: values } = trace.columns;
  const x: number[] = [], y: (number | null)[] = [];
  let broken = false;
  for (let i = 0; i < path.length; ++i) {
    if (!extruding[i]) { broken = true; continue; }
    if (broken && x.length) { x.push(path[i] as number); y.push(null); }
    broken = false;
    x.push(path[i] as number);
    y.push(values[i]);
  }
  return { x, y };
}

function pathCurves(report: Report, column: string): Curve[] | null {
  if (!report.trace!.columns[column]) return null;  // of a machine whose true tip nobody knows
  const off = report.names.gap_control === 'off';
  const curves: Curve[] = [];
  if (report.trace_without_gap_control)
    curves.push({ label: 'without gap control', colour: styleColour('without'), dash: [7, 4], ...alongPath(report.trace_without_gap_control, column) });
  curves.push({ label: off ? 'without gap control' : 'with gap control', colour: styleColour(off ? 'without' : 'with'), width: 1.8, ...alongPath(report.trace!, column) });
  return curves.some((curve) => curve.x.length > 1) ? curves : null;
}

function belief(report: Report): Chart['belief'] | undefined {
  if (!report.trace!.columns.stated_sigma_um) return undefined;
  const sigma = alongPath(report.trace!, 'stated_sigma_um').y, held = alongPath(report.trace!, 'believed_gap_mm');
  const edge = (side: number) => held.y.map((y, i) => (y === null || sigma[i] === null ? null : y + side * 3e-3 * (sigma[i] as number)));
  return { x: held.x, low: edge(-1), high: edge(1) };
}

function beliefNote(report: Report, drawn: boolean): string {
  if (!report.gap_belief_note) return '';
  if (!drawn) return ' No band of what the controller believes: ' + report.gap_belief_note + '.';
  const { stated_sigma_um: sigma, inside_stated_3_sigma_fraction: inside } = report.summary.gap || {};
  return ' Blue band: what the controller believes, three of its stated sigmas to either side (' + report.gap_belief_note + ').' +
    (inside === undefined ? '' : ' Median sigma ' + format.quantity(sigma, 'um') + '; the true gap is inside on ' + format.percent(inside) + ' of the path.');
}

function gap(report: Report): Chart | null {
  const curves = pathCurves(report, 'gap_mm');
  if (!curves) return null;
  const band = report.gap_band, held = belief(report);
  const { range, beyond } = nearlyAll(curves, band ? [0, 1.25 * band.max_mm] : [0]);
  return { title: 'Gap along the path', curves, unit: 'mm', decimals: 3, xLabel: 'path (mm)', yLabel: 'gap (mm)', range, belief: held, onPath: true,
    band: band && [band.min_mm, band.max_mm], lines: [...(band ? [{ at: band.aim_mm, colour: styleColour('aim'), dash: [2, 3] }] : []), { at: 0, colour: styleColour('ink'), dash: [] }],
    note: 'True distance from nozzle to surface along the tool axis.' + (band ? ' Green: the accepted band of ' + format.range(band.min_mm, band.max_mm, 'mm') + '; dotted: the aim, '
      + format.given(band.aim_mm, 'mm') + '\u00a0mm.' : '') + beliefNote(report, Boolean(held)) + beyondNote(beyond) };
}

function tip(report: Report): Chart | null {
  const curves = pathCurves(report, 'tip_error_um');
  if (!curves) return null;
  const accepted = report.summary.accuracy ? 1000 * report.summary.accuracy.tip_tolerance_mm : 0;
  const { range, beyond } = nearlyAll(curves, [0]);
  return { title: 'Tip error along the path', curves, unit: 'µm', decimals: 1, xLabel: 'path (mm)', yLabel: 'tip error (µm)', range, onPath: true,
    lines: accepted && accepted < range[1] ? [{ at: accepted, colour: styleColour('limit'), dash: [6, 4] }] : [],
    note: 'Distance of the true tip from where the program asks for it.' + (accepted ? ' Accepted: ' + format.quantity(accepted, 'um') + (accepted < range[1] ? ', dashed.' : ', above the scale.') : '') + beyondNote(beyond) };
}

function orientation(report: Report): Chart | null {
  const curves = pathCurves(report, 'orientation_error_mrad');
  if (!curves) return null;
  const { range, beyond } = nearlyAll(curves, [0]);
  return { title: 'Orientation error along the path', curves, unit: 'mrad', decimals: 3, xLabel: 'path (mm)', yLabel: 'orientation error (mrad)', range, onPath: true,
    note: 'Angle between the true tool and the programmed one.' + beyondNote(beyond) };
}

function speed(trace: Trace): Chart | null {
  const { time_s: t, x_mm: x, y_mm: y, z_mm: z } = trace.columns as Record<string, number[]>;
  const at: number[] = [], values: number[] = [];
  for (let i = 1; i < t.length; ++i) {
    const span = t[i] - t[i - 1];
    if (span <= 1e-6) continue;
    at.push(0.5 * (t[i] + t[i - 1]));
    values.push(Math.hypot(x[i] - x[i - 1], y[i] - y[i - 1], z[i] - z[i - 1]) / span);
  }
  if (!at.length) return null;
  const curves = [{ label: 'tip speed', colour: styleColour('with'), x: at, y: values }];
  return { title: 'Speed of the tip', curves, unit: 'mm/s', decimals: 2, xLabel: 'time (s)', yLabel: 'speed (mm/s)', range: nearlyAll(curves, [0]).range,
    note: 'In the frame of the work, mean between neighbouring samples.' };
}

// Without gap control, so that it shows the description alone; orders of magnitude lie between the two.
function calibration(report: Report, table: () => Node | null): Chart | null {
  if (!report.trace_before_calibration) return null;
  const { machine_before: before, machine_after: after } = report.summary.calibration;
  const curve = (label: string, trace: Trace, colour: string, dash?: number[]): Curve => {
    const { x, y } = alongPath(trace, 'tip_error_um');
    return { label, colour, dash, x, y: y.map((value) => (value !== null && value > 0 ? value : null)) };
  };
  const curves = [curve('before, ' + before, report.trace_before_calibration, styleColour('without'), [7, 4]),
    curve('after, ' + after, report.trace_without_gap_control || report.trace!, styleColour('with'))];
  if (!curves.some(({ x }) => x.length > 1)) return null;
  const values = curves.flatMap((c) => c.y).filter((y): y is number => y !== null);
  return { title: 'Tip error before and after calibration', curves, unit: 'µm', decimals: 1, log: true, onPath: true, before: table(),
    range: [Math.min(...values) / 1.5, Math.max(...values) * 1.5], note: 'The same program on the same twin without gap control, driven by either description. Logarithmic scale.',
    xLabel: 'path (mm)', yLabel: 'tip error (µm)' };
}

function profile(report: Report): Chart | null {
  if (!report.profile) return null;
  const curves = [{ label: 'height', colour: styleColour('with'), x: report.profile.position_mm, y: report.profile.height_um }];
  return { title: 'Profile of the printed surface', curves, unit: 'µm', decimals: 1, ofSurface: true, range: nearlyAll(curves, [0]).range,
    note: 'Height of what was printed along the chosen line, form removed. Ra and Rz: ' + report.profile.note + '.', xLabel: 'along the line (mm)', yLabel: 'height (µm)' };
}

// One chart a unit: lengths and angles do not share a scale.
function axes(report: Report): Chart[] {
  const units = [...new Set(report.axes.map((axis) => format.unitOfKey(axis.name)))];
  const time = report.trace!.columns.time_s as number[];
  return units.map((unit) => {
    const ofUnit = report.axes.filter((axis) => format.unitOfKey(axis.name) === unit);
    const curves = ofUnit.map((axis, i) => ({ label: axis.name.replace(/^axis_/, '').replace(/_[a-z]+$/, ''), colour: styleColour(kAxisColours[i % 8]),
      dash: i % 2 ? [6, 3] : undefined, x: time, y: report.trace!.columns[axis.name] as (number | null)[] }));
    const limits = [...new Set(ofUnit.flatMap((axis) => [axis.min, axis.max]).filter((v): v is number => v !== undefined))];
    const { range } = nearlyAll(curves, []);
    // Limits within a range of the motion are worth their place on the scale; others are said.
    const span = range[1] - range[0], near = limits.filter((limit) => limit > range[0] - span && limit < range[1] + span);
    const shown = format.unit(unit), struts = ofUnit.every((axis) => /^l\d/.test(axis.name));
    const low = Math.min(range[0], ...near.map((v) => v - 0.03 * span)), high = Math.max(range[1], ...near.map((v) => v + 0.03 * span));
    return { title: struts ? 'Strut lengths' : 'Axes (' + shown + ')', curves, unit: shown, decimals: 3, range: [low, high] as [number, number],
      lines: near.map((at) => ({ at, colour: styleColour('limit'), dash: [6, 4] })), xLabel: 'time (s)', yLabel: (struts ? 'strut length (' : 'axis (') + shown + ')',
      note: 'As the drives measured them.' + (near.length ? ' Long dashes: limits.' : '') + (near.length < limits.length ? ' Limits off the scale: '
        + limits.filter((v) => !near.includes(v)).sort((a, b) => a - b).map((v) => format.number(v, 1)).join(', ') + '\u00a0' + shown + '.' : '') };
  });
}

/** One table on a common x. undefined where a curve has no sample, which the plot bridges; null where it breaks. */
function merged(chart: Chart): uPlot.AlignedData {
  const curves = [...chart.curves];
  if (chart.belief)
    for (const y of [chart.belief.low, chart.belief.high]) curves.push({ label: '', colour: '', x: chart.belief.x, y });
  if (curves.every((curve) => curve.x === curves[0].x)) return [curves[0].x, ...curves.map((curve) => curve.y)] as uPlot.AlignedData;
  const rows: { x: number; c: number; i: number }[] = [];
  curves.forEach((curve, c) => curve.x.forEach((x, i) => rows.push({ x, c, i })));
  rows.sort((a, b) => a.x - b.x || a.i - b.i);
  const x: number[] = [], columns: (number | null | undefined)[][] = curves.map(() => []);
  for (const row of rows) {
    const same = x.length > 0 && x[x.length - 1] === row.x && columns[row.c][x.length - 1] === undefined;
    if (!same) { x.push(row.x); columns.forEach((column) => column.push(undefined)); }
    columns[row.c][x.length - 1] = curves[row.c].y[row.i];
  }
  return [x, ...columns] as uPlot.AlignedData;
}

/** Where the instant of the replay stands on a chart's axis, and the other way. */
function linked(trace: Trace, chart: Chart) {
  const time = trace.columns.time_s as number[], path = trace.columns.path_mm as number[];
  if (chart.ofSurface) return null;
  if (!chart.onPath) return { x: (t: number) => t, time: (x: number) => x };
  const between = (from: Numbers, to: Numbers) => (value: number) => {
    const a = from as number[], b = to as number[], i = lastNotAbove(a, value), j = Math.min(i + 1, a.length - 1);
    return a[j] > a[i] ? b[i] + (b[j] - b[i]) * Math.min(1, Math.max(0, (value - a[i]) / (a[j] - a[i]))) : b[i];
  };
  return { x: between(time, path), time: between(path, time) };
}

/** [px] between two labels, so that the widest does not meet its neighbour. */
function labelSpace(most: number): number { return Math.max(50, 8 * Math.round(most).toLocaleString().length + 12); }

function plot(report: Report, trace: Trace, chart: Chart, host: HTMLElement, clock: Clock | null) {
  const data = merged(chart);
  const link = linked(trace, chart);
  const soft = styleColour('soft'), line = styleColour('line');
  const value = (_: uPlot, v: number | null) => (v === null || v === undefined ? '\u2013' : format.number(v, chart.decimals) + '\u00a0' + chart.unit);
  const axis = { stroke: soft, grid: { stroke: line, width: 1 }, ticks: { stroke: line, width: 1 }, font: '12px system-ui, sans-serif', labelFont: '12px system-ui, sans-serif' };
  const series: uPlot.Series[] = [{ label: chart.xLabel, value: (_: uPlot, v: number | null) => (v === null || v === undefined ? '\u2013' : format.number(v, 2)) },
    ...chart.curves.map((curve) => ({ label: curve.label, stroke: curve.colour, width: curve.width || 1.5, dash: curve.dash, value, points: { show: false } }))];
  const bands: uPlot.Band[] = [];
  if (chart.belief) {
    for (const label of ['believed, low', 'believed, high']) series.push({ label, stroke: 'transparent', width: 0, points: { show: false }, value });
    bands.push({ series: [series.length - 1, series.length - 2], fill: styleColour('belief') });
  }
  const marks = link ? report.summary.findings.filter((f) => f.time_s > 0 && f.time_s <= (trace.columns.time_s[trace.columns.time_s.length - 1] as number)) : [];
  const u = new uPlot({
    width: host.clientWidth || 640, height: 240, series, bands, cursor: { y: false, points: { size: 6 } },
    scales: { x: { time: false }, y: chart.log ? { distr: 3, range: chart.range } : { range: chart.range } },
    axes: [{ ...axis, label: chart.xLabel, labelSize: 18, size: 34, space: (_: uPlot, __: number, ___: number, most: number) => labelSpace(most) }, { ...axis, label: chart.yLabel, labelSize: 18, size: 54 }],
    hooks: { drawClear: [(plot) => ground(plot, chart)], draw: [(plot) => overlay(plot, chart, marks, link && link.x)], ready: [(plot) => attach(plot)], setScale: [() => place()] },
    legend: { live: true },
  }, data, host);
  const now = element('div', { class: 'plot-now', 'aria-hidden': 'true' });
  let pressed = -1;
  function attach(plot: uPlot) {
    if (!clock || !link) return;
    plot.over.addEventListener('pointerdown', (event) => { pressed = event.clientX; });
    plot.over.addEventListener('pointerup', (event) => {
      if (pressed < 0 || Math.abs(event.clientX - pressed) > 3) return;
      clock.seek(link.time(plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, 'x')));
    });
  }
  function place() {
    if (!clock || !link || !u || !now.isConnected) return;
    const left = u.valToPos(link.x(clock.time), 'x');
    now.style.transform = 'translateX(' + left.toFixed(1) + 'px)';
    now.hidden = !(left >= 0 && left <= u.over.clientWidth);
  }
  if (clock && link) {
    u.over.append(now);
    clock.onTime(place);
  }
  // The edges of what is believed stand for one thing, which the note names.
  if (chart.belief) for (const row of [...host.querySelectorAll<HTMLElement>('.u-legend .u-series')].slice(-2)) row.hidden = true;
  host.setAttribute('role', 'group');
  host.setAttribute('aria-label', chart.title);
  new ResizeObserver(() => { if (host.clientWidth && Math.abs(host.clientWidth - u.width) > 1) { u.setSize({ width: host.clientWidth, height: 240 }); place(); } }).observe(host);
}

function ground(u: uPlot, chart: Chart) {
  if (!chart.band) return;
  const { ctx, bbox } = u;
  const top = u.valToPos(chart.band[1], 'y', true), bottom = u.valToPos(chart.band[0], 'y', true);
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.fillStyle = styleColour('band');
  ctx.fillRect(bbox.left, top, bbox.width, bottom - top);
  ctx.restore();
}

function overlay(u: uPlot, chart: Chart, marks: Finding[], x: ((time: number) => number) | null) {
  const { ctx, bbox } = u;
  const ratio = devicePixelRatio || 1;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  for (const { at, colour, dash } of chart.lines || []) {
    const y = u.valToPos(at, 'y', true);
    ctx.strokeStyle = colour;
    ctx.lineWidth = ratio;
    ctx.setLineDash(dash.map((d) => d * ratio));
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
  }
  // Where findings are: short ticks hanging from the top.
  if (x)
    for (const finding of marks) {
      ctx.fillStyle = styleColour(finding.severity === 'error' ? 'no-go' : 'warn');
      ctx.fillRect(u.valToPos(x(finding.time_s), 'x', true) - ratio, bbox.top, 2 * ratio, 8 * ratio);
    }
  for (const { time, colour } of chart.ticks || []) {
    ctx.fillStyle = colour;
    ctx.fillRect(u.valToPos(time, 'x', true) - ratio, bbox.top + bbox.height - 8 * ratio, 2 * ratio, 8 * ratio);
  }
  ctx.restore();
}
