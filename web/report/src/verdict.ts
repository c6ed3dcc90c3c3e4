// The answer, the reason, and the few figures that carry it.
import { element } from './elements';
import { format } from './format';
import type { Report } from './record';

const kGrades: Record<string, string> = { go: 'GO', 'go-with-warnings': 'GO with warnings', 'no-go': 'NO-GO' };

export function drawVerdict(report: Report, theme: HTMLElement): HTMLElement {
  const summary = report.summary;
  const errors = summary.findings.filter((f) => f.severity === 'error').length;
  const warnings = summary.findings.length - errors;
  const tally = format.plural(errors, 'error') + ' · ' + format.plural(warnings, 'warning');
  return element('header', {},
    element('div', { class: 'top' }, element('p', { class: 'eyebrow' }, 'Understudy rehearsal'), theme),
    element('h1', {}, report.title),
    element('div', { class: 'verdict ' + summary.grade },
      element('strong', {}, kGrades[summary.grade]),
      element('div', {},
        element('p', { class: 'reason' }, format.message(report.reason)),
        element('p', { class: 'tally' }, tally))),
    drawKeyFigures(report));
}

function drawKeyFigures(report: Report) {
  const { gap, accuracy, collision, print } = report.summary;
  const band = report.gap_band;
  const tiles: HTMLElement[] = [];
  const tile = (label: string, value: string, note?: string) => tiles.push(element('div', {},
    element('dt', {}, label), element('dd', {}, value), element('dd', { class: 'aside' }, note || '')));
  if (gap) {
    tile('Gap at the start', format.quantity(gap.start_mm, 'mm'),
      gap.open_loop_start_mm !== undefined ? 'without gap control ' + format.quantity(gap.open_loop_start_mm, 'mm') : '');
    tile('Path in the band', format.percent(gap.in_band_fraction),
      band ? 'band ' + format.range(band.min_mm, band.max_mm, 'mm') : '');
  }
  if (accuracy) {
    tile('Largest tip error', format.quantity(accuracy.tip_max_um, 'um'),
      'accepted ' + format.quantity(1000 * accuracy.tip_tolerance_mm, 'um') + (report.names.gap_control === 'off' ? ''
        : ', without gap control ' + format.quantity(accuracy.open_loop_tip_max_um, 'um')));
  }
  if (collision && collision.nozzle_clearance_mm !== undefined)
    tile('Nozzle to part, least', distance(collision.nozzle_clearance_mm), 'or to table or beads it ploughs');
  if (collision && collision.min_clearance_mm !== undefined)
    tile('Least clearance elsewhere', distance(collision.min_clearance_mm), collision.closest);
  if (print) {
    tile('Duration', formatDuration(print.duration_s), format.quantity(print.printed_mm, 'mm') + ' of filament printed');
  }
  return tiles.length ? element('dl', { class: 'key-figures' }, ...tiles) : null;
}

// Below zero a clearance is the depth of a contact.
function distance(clearance_mm: number): string {
  return clearance_mm < 0 ? format.quantity(-clearance_mm, 'mm') + ' deep' : format.quantity(clearance_mm, 'mm');
}

function formatDuration(seconds: number): string {
  if (seconds < 120) return format.number(seconds, 1) + '\u00a0s';
  const minutes = Math.floor(seconds / 60);
  const rest = Math.round(seconds - 60 * minutes);
  return minutes < 120 ? minutes + '\u00a0min ' + rest + '\u00a0s'
    : Math.floor(minutes / 60) + '\u00a0h ' + (minutes % 60) + '\u00a0min';
}
