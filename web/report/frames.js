'use strict';
// Pictures of the scene, and the laser frames with the dot that was measured and the dot that was there.
function drawPictures(report) {
  if (report.pictures.length === 0) return null;
  return section('Machine and part', null, element('div', { class: 'pictures' }, ...report.pictures.map((picture) =>
    element('figure', {},
      element('img', { src: picture.image, width: picture.width, height: picture.height, alt: picture.caption || 'scene' }),
      picture.caption ? element('figcaption', {}, picture.caption) : null))));
}

function drawFrames(report) {
  if (report.frames.length === 0) return null;
  const used = report.frames.filter((frame) => frame.used).length;
  const note = element('span', {},
    format.plural(report.frames.length, 'frame') + ' of the tool\u2019s microscope, ' + used + ' used. ',
    key('measured'), ' dot as measured, ', key('true'), ' dot where the beam truly meets the surface. Select a frame to enlarge it.');
  return section('Laser frames of the approach', note,
    element('div', { class: 'frames' }, ...report.frames.map((frame, i) => frameCard(frame, i + 1))));
}

function key(kind) {
  const svg = shape('svg', { class: 'key', viewBox: '0 0 20 20', 'aria-hidden': 'true' });
  svg.append(shape('rect', { width: 20, height: 20, rx: 3, class: 'ground' }));
  svg.append(...(kind === 'true' ? ring(10, 10, 6) : cross(10, 10, 7)));
  return svg;
}

function frameCard(frame, number) {
  const picture = frame.image ? framePicture(frame) : element('div', { class: 'no-image' }, 'no image');
  const card = element('figure', { class: frame.used ? 'used' : 'discarded' }, picture, frameCaption(frame, number));
  if (frame.image) picture.addEventListener('click', () => enlarge(frame, number));
  return card;
}

function framePicture(frame) {
  const [x, y, width, height] = frame.region;
  const svg = shape('svg', { viewBox: [0, 0, width, height].join(' '), role: 'img', 'aria-label': 'laser frame' });
  svg.append(shape('image', { href: frame.image, width, height }));
  // A pixel's coordinates name its centre.
  const place = (p) => [p[0] - x + 0.5, p[1] - y + 0.5];
  const size = Math.max(width, height);
  if (frame.true_px) svg.append(...ring(...place(frame.true_px), 0.055 * size));
  if (frame.measured_px) svg.append(...cross(...place(frame.measured_px), 0.085 * size));
  return svg;
}

// Every mark twice: dark below, coloured above, so that it stands out on black and on white.
function ring(x, y, r) {
  return ['halo', 'true'].map((kind) => shape('circle', { cx: x, cy: y, r, class: 'dot ' + kind }));
}

function cross(x, y, r) {
  const inner = 0.35 * r;
  const path = [[1, 0], [-1, 0], [0, 1], [0, -1]].map(([dx, dy]) =>
    'M' + (x + inner * dx) + ' ' + (y + inner * dy) + 'L' + (x + r * dx) + ' ' + (y + r * dy)).join('');
  return ['halo', 'measured'].map((kind) => shape('path', { d: path, class: 'dot ' + kind }));
}

function frameCaption(frame, number) {
  const rows = [];
  const row = (label, value) => rows.push(element('dt', {}, label), element('dd', {}, value));
  if (frame.reading_mm !== undefined)
    row('reading', format.quantity(frame.reading_mm, 'mm'));
  if (frame.true_gap_mm !== undefined) row('true gap', format.quantity(frame.true_gap_mm, 'mm'));
  if (frame.reading_mm !== undefined && frame.true_gap_mm !== undefined) {
    const error = 1000 * (frame.reading_mm - frame.true_gap_mm);
    row('error', (error > 0 ? '+' : '') + format.quantity(error, 'um'));
  }
  if (frame.sigma_um !== undefined) row('1 σ', format.quantity(frame.sigma_um, 'um'));
  const state = frame.used ? 'used' : 'discarded' + (frame.why ? ': ' + format.message(frame.why) : '');
  return element('figcaption', {},
    element('div', { class: 'frame-head' }, element('b', {}, '#' + number), format.quantity(frame.time_s, 's')),
    element('dl', {}, ...rows), element('p', { class: 'state' }, state));
}

function enlarge(frame, number) {
  const dialog = element('dialog', { class: 'frame-large' },
    element('figure', {}, framePicture(frame), frameCaption(frame, number)));
  dialog.addEventListener('click', () => dialog.close());
  dialog.addEventListener('close', () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}
