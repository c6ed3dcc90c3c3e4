// The replay: picture, controls, readings, and what is at hand beside them.
import { button, choice, element } from './elements';
import { format } from './format';
import { modesOf, type Mode } from './modes';
import { NoWebGl, Stage } from './stage';
import { drawProgram } from './program';
import { frameInset } from './frames';
import { readSections } from './beads';
import { lastNotAbove } from './pack';
import type { Clock } from './clock';
import type { Finding, Report, ReplayData } from './record';
import type { Run } from './run';

const kRates = [0.1, 0.25, 0.5, 1, 2, 5, 10, 30, 100, 300, 1000];

/** Findings that the run has an instant for, in order of time. */
export function findingsInTime(report: Report, run: Run): Finding[] {
  return report.summary.findings.filter((f) => f.time_s >= run.start && f.time_s <= run.end && (f.time_s > 0 || f.gcode_line)).sort((a, b) => a.time_s - b.time_s);
}

export function drawReplay(report: Report, data: ReplayData, run: Run, clock: Clock): { node: HTMLElement; stage: Stage | null } {
  const canvas = element('canvas', { role: 'img', 'aria-label': 'Machine and print at the instant of the replay' });
  const view = element('div', { class: 'view' }, canvas);
  const legend = element('div', { class: 'colour-key' });
  const sections = data.beads ? readSections(data.beads) : null;
  let stage: Stage | null = null;
  const notes: string[] = [];
  try {
    stage = new Stage(canvas, data, run, sections);
    notes.push(...stage.machine.left);
  } catch (error) {
    if (!(error instanceof NoWebGl)) throw error;
    canvas.remove();
    view.append(element('p', { class: 'no-webgl' }, 'This browser offers no WebGL, so the picture in three dimensions is left out. All else works: '
      + 'the rest of the replay, and below the pictures that were drawn with the run.'));
  }
  if (data.beads) {
    const { beads, within_um: within, one_stretch_of: every } = data.beads;
    notes.push(format.count(beads) + ' beads, drawn to within ' + format.quantity(within, 'um') + (every ? '; one stretch of ' + every + ' is drawn, the others are left out' : ''));
  } else {
    notes.push('Nothing was deposited');
  }
  if (data.part_left_out_triangles) notes.push('the part is left out: ' + format.count(data.part_left_out_triangles) + ' triangles');
  if (data.path.within_um === undefined) notes.push('the path is thinned to ' + format.count(data.path.points) + ' instants');
  const controls = element('div', { class: 'replay-controls' });
  let modes: Mode[] = [], mode: Mode | null = null;
  if (stage && sections && data.beads) {
    modes = modesOf(report, run, sections, data.beads.type_names || []);
    const first = modes[0].name;
    const choose = (name: string) => {
      mode = modes.find((m) => m.name === name)!;
      stage!.paint(mode.colour);
      legend.replaceChildren(mode.legend());
    };
    controls.append(choice('Colour', modes.map((m) => [m.name, m.label]), first, choose));
    choose(first);
  }
  if (stage) controls.append(...stageControls(stage, report));
  const node = element('section', { class: 'replay', 'aria-label': 'Replay' },
    element('div', { class: 'stage' }, view, frameInset(report, clock), legend),
    timeline(report, run, clock), readings(report, run, clock, sections && { time: sections.time, mode: () => mode }), controls,
    element('p', { class: 'note' }, notes.join('; ') + '.'));
  if (stage) {
    const shown = stage;
    clock.onTime((time) => shown.show(time));
  }
  const pane = drawProgram(report, data, run, clock);
  return { node: element('div', { class: 'replay-and-program' }, node, pane), stage };
}

function stageControls(stage: Stage, report: Report): HTMLElement[] {
  const share = element('input', { type: 'range', min: 0, max: 1, step: 0.005, value: 0.5, 'aria-label': 'Place of the section', disabled: '' });
  let axis = '';
  const cut = () => stage.section(axis, Number(share.value));
  share.addEventListener('input', cut);
  const follow = element('input', { type: 'checkbox' });
  follow.addEventListener('change', () => stage.follow(follow.checked));
  const columns = report.trace && report.trace.columns;
  const error = columns && columns.programmed_x_mm ? [choice('Tip error drawn', [['0', 'not'], ['1', 'as large'], ['10', '10 times'], ['100', '100 times'], ['1000', '1000 times']], '0',
    (times) => stage.exaggerate(columns, Number(times)))] : [];
  return [
    choice('Machine', [['solid', 'solid'], ['see-through', 'see-through'], ['hidden', 'hidden']], 'solid', (look) => { stage.machine.setLook(look); stage.ask(); }),
    element('span', { class: 'choice' }, choice('Section', [['', 'none'], ['x', 'across x'], ['y', 'across y'], ['z', 'across z']], '', (value) => {
      axis = value;
      share.disabled = axis === '';
      cut();
    }), share),
    element('span', { class: 'choice', role: 'group', 'aria-label': 'Look at' }, element('span', {}, 'Look at'),
      ...[['all', 'all'], ['part', 'part'], ['tool', 'tool']].map(([at, label]) => button(label, () => stage.look(at)))),
    element('label', { class: 'choice' }, follow, element('span', {}, 'follow the tool')), ...error,
  ];
}

function timeline(report: Report, run: Run, clock: Clock): HTMLElement {
  const found = findingsInTime(report, run);
  const play = button('Play', () => clock.toggle(), { class: 'play' });
  clock.onState(() => { play.textContent = clock.playing ? 'Pause' : 'Play'; });
  const scrub = element('input', { type: 'range', min: run.start, max: run.end, step: 'any', class: 'scrub', 'aria-label': 'Instant of the replay' });
  scrub.addEventListener('input', () => clock.seek(Number(scrub.value)));
  scrub.addEventListener('keydown', (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1, PageUp: 20, PageDown: -20 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    clock.seek(clock.time + step * (run.end - run.start) / 500);
  });
  const at = element('output', { class: 'at-time' });
  clock.onTime((time) => {
    scrub.value = String(time);
    scrub.setAttribute('aria-valuetext', format.number(time, 2) + ' seconds');
    at.textContent = format.number(time, 2) + '\u00a0/\u00a0' + format.number(run.end, 1) + '\u00a0s';
  });
  const wanted = (run.end - run.start) / 40;
  const rate = kRates.find((r) => r >= wanted) || kRates[kRates.length - 1];
  clock.setRate(rate);
  const marks = element('div', { class: 'scrub-marks', 'aria-hidden': 'true' }, ...thin(found, 400).map((f) => element('i', { class: f.severity,
    style: 'left: ' + (100 * (f.time_s - run.start) / (run.end - run.start || 1)).toFixed(3) + '%' })));
  const jump = (forward: boolean) => {
    const next = forward ? found.find((f) => f.time_s > clock.time + 2e-3) : [...found].reverse().find((f) => f.time_s < clock.time - 2e-3);
    if (next) clock.seek(next.time_s);
  };
  const jumps = found.length ? [button('Previous finding', () => jump(false), { class: 'jump' }), button('Next finding', () => jump(true), { class: 'jump next-finding' })] : [];
  return element('div', { class: 'timeline' },
    element('div', { class: 'scrub-box' }, marks, scrub),
    element('div', { class: 'timeline-row' }, play, choice('Rate', kRates.map((r) => [String(r), r + '\u00d7']), String(rate), (value) => clock.setRate(Number(value))), at, ...jumps));
}

function thin<T>(items: T[], most: number): T[] {
  return items.length <= most ? items : items.filter((_, i) => i % Math.ceil(items.length / most) === 0);
}

/** The figures of the instant. */
function readings(report: Report, run: Run, clock: Clock, beads: { time: Float32Array; mode: () => Mode | null } | null): HTMLElement {
  const values = new Map<string, HTMLElement>();
  const cell = (label: string) => {
    const dd = element('dd');
    values.set(label, dd);
    return element('div', { class: label === 'Tip at' ? 'broad' : null }, element('dt', {}, label), dd);
  };
  const labels = ['Line', ...(report.gap_band ? ['Gap'] : []), 'Tip error', 'Orientation error', 'Tip speed', 'Tip at'];
  const node = element('dl', { class: 'readings' }, ...labels.map(cell), beads ? cell('Newest bead') : null);
  clock.onTime((time) => {
    const put = (label: string, text: string) => { const dd = values.get(label); if (dd) dd.textContent = text; };
    const gap = run.valueAt(run.gap, time), p = run.tool.place, i = 3 * run.indexAt(time);
    put('Line', String(run.lineAt(time)));
    put('Gap', isFinite(gap) ? format.quantity(gap / 1000, 'mm') : 'nothing below');
    put('Tip error', format.quantity(run.valueAt(run.tipError, time), 'um'));
    put('Orientation error', format.quantity(run.valueAt(run.turnError, time), 'mrad'));
    put('Tip speed', format.quantity(run.speedAt(time), 'mm/s'));
    put('Tip at', [0, 1, 2].map((c) => format.number(p[i + c], 2)).join(', ') + '\u00a0mm');
    const mode = beads && beads.mode();
    if (beads && mode) put('Newest bead', time < beads.time[0] ? 'none yet' : mode.text(lastNotAbove(beads.time, time)) || '\u2013');
  });
  return node;
}
