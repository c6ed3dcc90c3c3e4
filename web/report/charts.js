'use strict';
// Curves along the path and over time, by dygraphs. Colours of Okabe and Ito: apart for colour-blind eyes too.
const kColour = { with: '#0072b2', without: '#c26a00', band: 'rgba(0, 158, 115, 0.14)', belief: 'rgba(86, 180, 233, 0.32)', aim: '#007a59', limit: '#a33b00' };
const kAxisColours = ['#0072b2', '#d55e00', '#009e73', '#a8558a', '#b38300', '#3a9bd6', '#333333', '#8a6d4b'];

function drawCharts(report, add) {
  if (!report.trace) {
    if (!report.summary.print) add(section('The run', null, element('p', {},
      'The program was not run: there are no curves, and no figures of print, accuracy or gap.')));
    return;
  }
  const gap = gapChart(report);
  const tip = tipChart(report);
  for (const chart of [calibrationChart(report), gap, tip, profileChart(report), ...axisCharts(report)]) {
    if (!chart) continue;
    chart.marks = chart.ofSurface ? [] : findingMarks(report, chart.onPath);
    if (chart.marks.length) chart.note += ' Ticks at the top edge: findings.';
    const legend = element('div', { class: 'legend' });
    const canvas = element('div', { class: 'chart' });
    add(section(chart.title, chart.note, chart.table, legend, canvas));
    plot(chart, canvas, legend);
  }
}

// Rows [x, y] of what was extruded; NaN breaks the curve where extrusion paused or nothing lies below.
function alongPath(trace, column) {
  const { extruding, path_mm: path, [column]: values } = trace.columns;
  const rows = [];
  let broken = false;
  for (let i = 0; i < path.length; ++i) {
    if (!extruding[i]) { broken = true; continue; }
    if (broken && rows.length) rows.push([path[i], NaN]);
    broken = false;
    rows.push([path[i], values[i] === null ? NaN : values[i]]);
  }
  return rows;
}

// One table on a common x; null where a curve has no sample, which dygraphs bridges.
function merge(curves) {
  const rows = [];
  curves.forEach((curve, c) => curve.rows.forEach(([x, y], order) => {
    const row = [x, ...curves.map(() => null)];
    row[c + 1] = y;
    rows.push({ row, order });
  }));
  return rows.sort((a, b) => a.row[0] - b.row[0] || a.order - b.order).map(({ row }) => row);
}

function pathCurves(report, column) {
  const uncontrolled = report.names.gap_control === 'off';
  const curves = [{ label: uncontrolled ? 'without gap control' : 'with gap control',
    colour: uncontrolled ? kColour.without : kColour.with, rows: alongPath(report.trace, column) }];
  if (report.trace_without_gap_control) {
    curves.unshift({ label: 'without gap control', colour: kColour.without, dash: [7, 4],
      rows: alongPath(report.trace_without_gap_control, column) });
  }
  return curves.some((curve) => curve.rows.length > 1) ? curves : null;
}

// Pieces [[x, low, high], ...] of what the controller believed, three of its sigmas to either side.
function believedBand(report) {
  if (!report.trace.columns.stated_sigma_um) return [];
  const sigma = alongPath(report.trace, 'stated_sigma_um'), gap = alongPath(report.trace, 'believed_gap_mm');
  const pieces = [[]];
  gap.forEach(([x, y], i) => {
    const margin = 3e-3 * sigma[i][1];
    if (isFinite(y) && isFinite(margin)) pieces[pieces.length - 1].push([x, y - margin, y + margin]);
    else if (pieces[pieces.length - 1].length) pieces.push([]);
  });
  return pieces.filter((piece) => piece.length > 1);
}

// What the band is, and how much of the truth it holds; or why there is none.
function believedNote(report, pieces) {
  if (!report.gap_belief_note) return '';
  if (!pieces.length) return ' No band of what the controller believes: ' + report.gap_belief_note + '.';
  const { stated_sigma_um: sigma, stated_path_fraction: stated, inside_stated_3_sigma_fraction: inside } = report.summary.gap || {};
  return ' Blue band: what the controller believes, three of its stated sigmas to either side (' + report.gap_belief_note + ').' +
    (inside === undefined ? '' : ' Median sigma ' + format.number(sigma, 1) + '\u00a0µm; the true gap is inside on ' +
      format.number(100 * inside, 1) + '\u00a0% of the path' + (stated < 0.9995 ? ' for which it states one, ' +
      format.number(100 * stated, 1) + '\u00a0% of all' : '') + '.');
}

function gapChart(report) {
  const curves = pathCurves(report, 'gap_mm');
  if (!curves) return null;
  const band = report.gap_band;
  const belief = believedBand(report);
  const note = 'True distance from nozzle to surface along the tool axis.' + (band ? ' Shaded: the accepted band of ' +
    band.min_mm + '\u2013' + band.max_mm + ' mm; dotted: the aim, ' + band.aim_mm + ' mm.' : '') +
    believedNote(report, belief);
  return { title: 'Gap along the path', note, curves, unit: 'mm', decimals: 3,
    xLabel: 'path length (mm)', yLabel: 'gap (mm)', include: band ? [0, 1.25 * band.max_mm] : [0],
    belief, band: band && [band.min_mm, band.max_mm], aim: band && band.aim_mm, zero: true, zeroName: 'surface', onPath: true };
}

function tipChart(report) {
  const curves = pathCurves(report, 'tip_error_um');
  if (!curves) return null;
  return { title: 'Tip error along the path', curves, unit: 'µm', decimals: 1, include: [0], zero: true,
    onPath: true,
    note: 'Distance of the true tip from where the program asks for it.',
    xLabel: 'path length (mm)', yLabel: 'tip error (µm)' };
}

// Without gap control, so that it shows the description alone; orders of magnitude lie between the two.
function calibrationChart(report) {
  if (!report.trace_before_calibration) return null;
  const { machine_before: before, machine_after: after } = report.summary.calibration;
  const openLoop = report.trace_without_gap_control || report.trace;
  const curve = (label, trace, colour, dash) => ({ label, colour, dash,
    rows: alongPath(trace, 'tip_error_um').map(([x, y]) => [x, y > 0 ? y : NaN]) });
  const curves = [curve('before, ' + before, report.trace_before_calibration, kColour.without, [7, 4]),
    curve('after, ' + after, openLoop, kColour.with)];
  if (!curves.some(({ rows }) => rows.length > 1)) return null;
  return { title: 'Tip error before and after calibration', curves, unit: 'µm', decimals: 1, log: true, include: [],
    onPath: true, table: calibrationTable(report.summary.calibration),
    note: 'The same program on the same twin without gap control, driven by either description. Logarithmic scale.',
    xLabel: 'path length (mm)', yLabel: 'tip error (µm)' };
}

function profileChart(report) {
  if (!report.profile) return null;
  const { position_mm: x, height_um: y } = report.profile;
  return { title: 'Profile of the printed surface', ofSurface: true, unit: 'µm', decimals: 1, include: [0],
    curves: [{ label: 'height', colour: kColour.with, rows: x.map((value, i) => [value, y[i]]) }],
    note: 'Height of what was printed along the chosen line, form removed. Ra and Rz: ' + report.profile.note + '.',
    xLabel: 'along the line (mm)', yLabel: 'height (µm)' };
}

// One chart a unit: lengths and angles do not share a scale.
function axisCharts(report) {
  const units = [...new Set(report.axes.map((axis) => format.unitOfKey(axis.name)))];
  return units.map((unit) => {
    const axes = report.axes.filter((axis) => format.unitOfKey(axis.name) === unit);
    const time = report.trace.columns.time_s;
    const curves = axes.map((axis, i) => ({ label: axis.name.replace(/_[a-z]+$/, ''), colour: kAxisColours[i % 8],
      rows: report.trace.columns[axis.name].map((value, k) => [time[k], value]) }));
    const limits = [...new Set(axes.flatMap((axis) => [axis.min, axis.max]).filter((v) => v !== undefined))];
    const struts = axes.every((axis) => /^l\d/.test(axis.name));
    const shown = format.unit(unit);
    return { title: struts ? 'Strut lengths' : 'Axes', curves, limits, include: limits, unit: shown, decimals: 3,
      note: limits.length ? 'As the drives measured them. Dashed lines: the limits.' : 'As the drives measured them.',
      xLabel: 'time (s)', yLabel: (struts ? 'strut length (' : 'axis (') + shown + ')', shared: true };
  });
}

// A scale that holds every value and what must be seen beside them.
function valueRange(chart) {
  let low = Math.min(...chart.include), high = Math.max(...chart.include);
  for (const { rows } of chart.curves) {
    for (const [, y] of rows) {
      if (y < low) low = y;
      if (y > high) high = y;
    }
  }
  if (chart.log) return [low / 1.5, high * 1.5];
  const pad = 0.06 * (high - low || 1);
  return [chart.zero && low === 0 ? 0 : low - pad, high + pad];
}

function sharedRows(curves) {
  return curves[0].rows.map(([x], i) => [x, ...curves.map((curve) => curve.rows[i][1])]);
}

function underlay(chart, context, area, graph) {
  const y = (value) => graph.toDomYCoord(value);
  const line = (value, colour, dash) => {
    context.save();
    context.strokeStyle = colour;
    context.setLineDash(dash);
    context.beginPath();
    context.moveTo(area.x, y(value));
    context.lineTo(area.x + area.w, y(value));
    context.stroke();
    context.restore();
  };
  if (chart.band) {
    context.fillStyle = kColour.band;
    context.fillRect(area.x, y(chart.band[1]), area.w, y(chart.band[0]) - y(chart.band[1]));
  }
  for (const piece of chart.belief || []) {
    context.save();
    context.beginPath();
    context.rect(area.x, area.y, area.w, area.h);
    context.clip();
    context.fillStyle = kColour.belief;
    context.beginPath();
    for (const [x, low] of piece) context.lineTo(graph.toDomXCoord(x), y(low));
    for (const [x, , high] of [...piece].reverse()) context.lineTo(graph.toDomXCoord(x), y(high));
    context.fill();
    context.restore();
  }
  if (chart.aim) line(chart.aim, kColour.aim, [2, 3]);
  for (const limit of chart.limits || []) line(limit, kColour.limit, [6, 4]);
  if (chart.zeroName && graph.yAxisRange()[0] < 0) {
    line(0, '#1c2329', []);
    context.fillStyle = '#1c2329';
    context.font = '12px system-ui, sans-serif';
    context.fillText(chart.zeroName, area.x + 6, y(0) - 4);
  }
  // Where findings are: short ticks hanging from the top.
  for (const { x, severity } of chart.marks) {
    const at = graph.toDomXCoord(x);
    if (at < area.x || at > area.x + area.w) continue;
    context.fillStyle = severity === 'error' ? kColour.limit : '#b38300';
    context.fillRect(at - 1, area.y, 2, 9);
  }
}

// Findings of the run as [x, severity] on a chart's axis: time itself, or the path travelled by then.
function findingMarks(report, onPath) {
  const { time_s: time, path_mm: path } = report.trace.columns;
  const last = time[time.length - 1];
  return report.summary.findings.filter((f) => f.time_s <= last).map((f) => {
    const i = time.findIndex((t) => t >= f.time_s);
    return { x: onPath ? path[i] : f.time_s, severity: f.severity };
  });
}

function drawLegend(chart, data) {
  const at = data.x === undefined ? '' : data.xHTML + '\u00a0' + chart.xLabel.replace(/.*\((.*)\)/, '$1');
  const entries = chart.curves.map((curve, i) => {
    const y = data.series[i] && data.series[i].y;
    const value = typeof y === 'number' && isFinite(y) ? ' ' + format.number(y, chart.decimals) + '\u00a0' + chart.unit : '';
    return element('span', {}, legendLine(curve), curve.label, element('b', {}, value));
  });
  return element('div', {}, ...entries, element('span', { class: 'at' }, at));
}

function legendLine(curve) {
  return shape('svg', { viewBox: '0 0 26 8', class: 'stroke' }, shape('line', { x1: 0, x2: 26, y1: 4, y2: 4,
    stroke: curve.colour, 'stroke-width': 2.5, 'stroke-dasharray': curve.dash ? curve.dash.join(' ') : null }));
}

function plot(chart, canvas, legend) {
  const labels = ['x', ...chart.curves.map((curve) => curve.label)];
  const series = {};
  for (const curve of chart.curves) series[curve.label] = { strokePattern: curve.dash || null };
  const rows = chart.shared ? sharedRows(chart.curves) : merge(chart.curves);
  new Dygraph(canvas, rows, {
    labels, series, colors: chart.curves.map((curve) => curve.colour),
    xlabel: chart.xLabel, ylabel: chart.yLabel, valueRange: valueRange(chart),
    connectSeparatedPoints: true, strokeWidth: 1.6, highlightCircleSize: 3,
    gridLineColor: '#e4e7ea', axisLineColor: '#9aa3ab', axisLabelFontSize: 12, xLabelHeight: 20, yLabelWidth: 20,
    rightGap: 14, logscale: Boolean(chart.log), axes: { y: { axisLabelWidth: 52 }, x: { pixelsPerLabel: 70 } },
    xRangePad: 4, labelsDiv: legend, legend: 'always',
    legendFormatter: (data) => drawLegend(chart, data).innerHTML,
    underlayCallback: (context, area, graph) => underlay(chart, context, area, graph),
  });
}
