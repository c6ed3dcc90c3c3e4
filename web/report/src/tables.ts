// Every figure of the summary, strands, and where it all comes from: folded until they are asked for.
import { element, folded, section } from './elements';
import { format } from './format';
import type { Report } from './record';

const kGroupTitles: Record<string, string> = {
  placement: 'Placement', print: 'Print', accuracy: 'Accuracy', calibration: 'Calibration', registration: 'Part as found', gap: 'Gap', sag: 'Sag', collision: 'Collision', surface: 'Surface', removal: 'Milling', engine: 'Engine',
};

const kFigureLabels: Record<string, string> = {
  duration_s: 'Duration', moves: 'Moves', extruded_mm: 'Filament fed', printed_mm: 'Of that, printed', purged_mm: 'Of that, purged at a standstill',
  missing_mm: 'Of that, missing on the part', primed_mm: 'Besides, pushed back after retractions',
  deposited_mm: 'Laid on something, sticks', spanning_mm: 'Laid in air, held',
  travel_mm: 'Travel without extrusion',
  tip_rms_um: 'Tip error, RMS', tip_p95_um: 'Tip error, 95th percentile', tip_max_um: 'Tip error, largest',
  machine_before: 'Machine before', machine_after: 'Machine after', not_run_before: 'Not run before',
  tip_rms_before_um: 'Tip error before, RMS', tip_rms_after_um: 'Tip error after, RMS',
  tip_p95_before_um: 'Tip error before, 95th percentile', tip_p95_after_um: 'Tip error after, 95th percentile',
  tip_max_before_um: 'Tip error before, largest', tip_max_after_um: 'Tip error after, largest',
  orientation_max_before_mrad: 'Orientation error before, largest', orientation_max_after_mrad: 'Orientation error after, largest',
  orientation_max_mrad: 'Orientation error, largest', open_loop_tip_max_um: 'Tip error without gap control, largest',
  tip_tolerance_mm: 'Tip error accepted', orientation_tolerance_deg: 'Orientation error accepted',
  places: 'Places measured', left_out: 'Places left out', seen: 'Freedoms seen, of six', unseen: 'Not seen, left as drawn', refused: 'Not printed',
  reference_x_mm: 'Centre of the places, x', reference_y_mm: 'Centre of the places, y', reference_z_mm: 'Centre of the places, z',
  shift_x_um: 'Shift there, x', shift_y_um: 'Shift there, y', shift_z_um: 'Shift there, z',
  shift_sigma_x_um: 'Shift, 1 sigma, x', shift_sigma_y_um: 'Shift, 1 sigma, y', shift_sigma_z_um: 'Shift, 1 sigma, z',
  turn_x_mrad: 'Turn about x', turn_y_mrad: 'Turn about y', turn_z_mrad: 'Turn about z',
  turn_sigma_x_mrad: 'Turn, 1 sigma, about x', turn_sigma_y_mrad: 'Turn, 1 sigma, about y', turn_sigma_z_mrad: 'Turn, 1 sigma, about z',
  chi_square: 'Chi-square of what the fit leaves', degrees_of_freedom: 'Its degrees of freedom', chi_square_limit: 'Refused above',
  place_sigma_um: 'Each place off besides noise, 1 sigma',
  normal_sigma_max_um: 'Surface found within, 1 sigma, worst place', normal_error_rms_um: 'Surface truly off, RMS', normal_error_max_um: 'Surface truly off, largest',
  commanded_mm: 'Commanded', open_loop_start_mm: 'At the start, without gap control', start_mm: 'At the start',
  path_min_mm: 'Least on the path', path_mean_mm: 'Mean on the path', path_max_mm: 'Largest on the path',
  in_band_fraction: 'Path inside the band', frames: 'Laser frames taken',
  believed_mean_mm: 'Believed by the controller, mean', stated_sigma_um: 'Its stated uncertainty, 1 sigma',
  stated_path_fraction: 'Path for which it states one', inside_stated_3_sigma_fraction: 'Of that, true gap within 3 sigma',
  max_um: 'Sag, largest', strands: 'Strands in air', unsupported_mm: 'Length in air', diameter_min_mm: 'Strand, thinnest', diameter_max_mm: 'Strand, thickest',
  ra_um: 'Roughness Ra', rz_um: 'Roughness Rz', deviation_p95_um: 'Deviation from the intended part, 95th percentile',
  min_clearance_mm: 'Least clearance, but for the nozzle over its work', closest: 'These two',
  nozzle_clearance_mm: 'Nozzle to what it prints on, least', checks: 'Checks', pairs: 'Pairs of bodies',
  name: 'Name', version: 'Version', timestep_s: 'Time step', steps: 'Steps',
  closure_max_um: 'Loop closure error, largest',
};

function figureText(key: string, value: any): string {
  if (typeof value === 'string') return value;
  if (Array.isArray(value)) return value.join('; ');
  if (key.endsWith('_fraction')) return format.percent(value);
  if (key === 'timestep_s') return format.quantity(1000 * value, '') + '\u00a0ms';
  const unit = format.unitOfKey(key);
  if (unit) return format.quantity(value, unit);
  return Number.isInteger(value) ? format.count(value) : format.quantity(value, '');
}

export function drawFigures(report: Report): HTMLElement | null {
  const groups = Object.entries(report.summary).filter(([key, value]) =>
    key !== 'provenance' && value && typeof value === 'object' && !Array.isArray(value));
  if (groups.length === 0) return null;
  return folded('All figures', element('div', { class: 'figures' }, ...groups.map(([key, values]) =>
    element('table', {}, element('caption', {}, kGroupTitles[key] || key),
      element('tbody', {}, ...Object.entries(values as Record<string, any>).filter(([, value]) => value !== '').map(([name, value]) => element('tr', {},
        element('th', { scope: 'row' }, kFigureLabels[name] || format.kind(name)),
        element('td', { class: Array.isArray(value) || typeof value === 'string' ? 'text' : 'number' }, figureText(name, value)))))))));
}

export function calibrationTable(figures: Record<string, any>): HTMLElement {
  const rows = [['Tip error, RMS', 'tip_rms', 'um'], ['Tip error, 95th percentile', 'tip_p95', 'um'],
    ['Tip error, largest', 'tip_max', 'um'], ['Orientation error, largest', 'orientation_max', 'mrad']];
  const number = (text: string) => element('td', { class: 'number' }, text);
  return element('table', { class: 'comparison' },
    element('thead', {}, element('tr', {}, element('th', {}, ''),
      ...['Before', 'After', 'Before / after'].map((text) => element('th', { class: 'number' }, text)))),
    element('tbody', {}, ...rows.map(([label, key, unit]) => {
      const before = figures[key + '_before_' + unit], after = figures[key + '_after_' + unit];
      return element('tr', {}, element('th', { scope: 'row' }, label), number(format.quantity(before, unit)),
        number(format.quantity(after, unit)), number(after > 0 ? format.quantity(before / after, '1') : '\u2013'));
    })));
}

// The description before the calibration may not reach what the program asks for.
export function drawCalibrationNotRun(report: Report): HTMLElement | null {
  const calibration = report.summary.calibration;
  if (!calibration || !calibration.not_run_before) return null;
  return section('Tip error before and after calibration', null, element('p', {}, 'Not compared: with the description before, ' +
    calibration.machine_before + ', the program does not run: ' + format.message(calibration.not_run_before) + '.'));
}

// Those that sag most, as the record sorts them.
export function drawStrands(report: Report): HTMLElement | null {
  if (!report.strands) return null;
  const all = report.summary.sag.strands;
  const head = ['Line', 'Time', 'Length', 'Thickness', 'Speed', 'Sag', 'Laid in', 'Solid after', 'Far end'];
  const rows = report.strands.map((strand) => element('tr', {}, ...[
    String(strand.line), format.quantity(strand.time_s, 's'), format.quantity(strand.length_mm, 'mm'),
    format.quantity(strand.diameter_mm, 'mm'), format.quantity(strand.speed_mm_per_s, 'mm/s'),
    strand.sag_um === undefined ? 'not solved' : (strand.small ? '' : '> ') + format.quantity(strand.sag_um, 'um'),
    format.quantity(strand.duration_s, 's'), format.quantity(strand.solid_after_s, 's'),
    strand.held_at_end ? 'held' : 'free'].map((text, i) => element('td', { 'data-label': head[i], class: 'number' }, text))));
  return folded('Strands in air', element('p', { class: 'note' }, 'How far each lies from where it was laid, once it is solid.' +
    (all > rows.length ? ' The ' + rows.length + ' that sag most of ' + all + '.' : '')),
    element('table', { class: 'findings' },
      element('thead', {}, element('tr', {}, ...head.map((h) => element('th', { class: 'number' }, h)))),
      element('tbody', {}, ...rows)));
}

export function drawDeviation(report: Report): HTMLElement | null {
  if (!report.deviation_note) return null;
  return section('Surface as printed', null, element('p', {}, format.message(report.deviation_note[0].toUpperCase() +
    report.deviation_note.slice(1) + '.')));
}

export function drawProvenance(report: Report): HTMLElement {
  const provenance: Record<string, any> = report.summary.provenance || {};
  const rows = ([
    ['Program', report.names.program, provenance.program_sha256],
    ['Machine', report.names.machine, provenance.machine_sha256],
    ['Machine before', (report.summary.calibration || {}).machine_before, provenance.machine_before_sha256],
    ['Fixture', report.names.fixture],
    ['Gap control', report.names.gap_control],
    ['As built', provenance.as_built],
    ['Made to go wrong', (provenance.faults || []).join('; ')],
    ['Seed', report.names.seed],
    ['Understudy', provenance.version],
    ['Libraries', Object.entries(provenance.libraries || {}).map((library) => library.join(' ')).join(', ')],
    ['Command', provenance.command],
  ] as [string, string | undefined, string?][]).filter((row) => row[1]);
  return folded('Provenance', element('table', { class: 'provenance' }, element('tbody', {},
    ...rows.map(([label, text, hash]) => element('tr', {}, element('th', { scope: 'row' }, label),
      element('td', {}, label === 'Command' ? element('code', {}, text) : text,
        hash ? element('code', { class: 'hash' }, 'sha256 ' + hash) : null))))));
}

/** As they were drawn with the run: what paper and browsers without WebGL show. */
export function drawPictures(report: Report, open: boolean): HTMLElement | null {
  if (report.pictures.length === 0) return null;
  const node = folded('Pictures', element('div', { class: 'pictures' }, ...report.pictures.map((picture) =>
    element('figure', {},
      element('img', { src: picture.image, width: picture.width, height: picture.height, alt: picture.caption || 'scene', loading: 'lazy' }),
      picture.caption ? element('figcaption', {}, picture.caption) : null))));
  if (open) node.setAttribute('open', '');
  return node;
}
