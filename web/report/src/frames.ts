// The laser frames: the one of the instant inside the replay, and all of them below, with the dot that was measured and the dot that was there.
import { element, folded, shape } from './elements';
import { format } from './format';
import type { Clock } from './clock';
import type { Frame, Report } from './record';

const kWindow = 64;  // [px] of the sensor that a small picture shows about its dot

export function drawFrames(report: Report): HTMLElement | null {
  if (report.frames.length === 0) return null;
  const used = report.frames.filter((frame) => frame.used).length;
  const note = element('p', { class: 'note' },
    format.plural(report.frames.length, 'frame') + ' of the tool\u2019s microscope, ' + used + ' used. ',
    key('measured'), ' dot as measured, ', key('true'), ' dot where the beam truly meets the surface. Grey levels are stretched by the factor that each frame states.'
    + ' Select a frame to see all of it.');
  return folded('Laser frames', note, element('div', { class: 'frames' }, ...report.frames.map((frame, i) => frameCard(frame, i + 1))));
}

/** The newest frame of the instant, in the corner of the replay. */
export function frameInset(report: Report, clock: Clock): HTMLElement {
  const box = element('div', { class: 'frame-inset' });
  const frames = report.frames.filter((frame) => frame.image && frame.region);
  let shown: Frame | null = null;
  clock.onTime((time) => {
    let newest: Frame | null = null;
    for (const frame of frames) if (frame.time_s <= time) newest = frame;
    if (newest === shown) return;
    shown = newest;
    box.hidden = !newest;
    if (!newest) { box.replaceChildren(); return; }
    const stretch = element('span');
    const reading = newest.reading_mm === undefined ? 'no reading' : 'read ' + format.quantity(newest.reading_mm, 'mm');
    const truth = newest.true_gap_mm === undefined ? '' : ', true ' + format.quantity(newest.true_gap_mm, 'mm');
    box.replaceChildren(framePicture(newest, true, stretch), element('p', {}, 'Microscope, ' + format.quantity(newest.time_s, 's')),
      element('p', {}, reading + truth), element('p', {}, stretch));
  });
  box.hidden = !shown;
  return box;
}

function key(kind: string): SVGElement {
  const svg = shape('svg', { class: 'key', viewBox: '0 0 20 20', 'aria-hidden': 'true' });
  svg.append(shape('rect', { width: 20, height: 20, rx: 3, class: 'ground' }));
  svg.append(...(kind === 'true' ? ring(10, 10, 6) : cross(10, 10, 7)));
  return svg;
}

function frameCard(frame: Frame, number: number): HTMLElement {
  const stretch = element('span');
  const picture = frame.image && frame.region ? element('button', { type: 'button', class: 'frame-picture', 'aria-label': 'Frame ' + number + ', all of it' },
    framePicture(frame, true, stretch)) : element('div', { class: 'no-image' }, 'no image');
  const card = element('figure', { class: frame.used ? 'used' : 'discarded' }, picture, frameCaption(frame, number, stretch));
  if (frame.image && frame.region) picture.addEventListener('click', () => enlarge(frame, number));
  return card;
}

/** Whole, or a window of one size about the dot, so that neighbours compare. */
function framePicture(frame: Frame, windowed: boolean, stretch: HTMLElement): SVGElement {
  const [x, y, width, height] = frame.region!;
  // A pixel's coordinates name its centre.
  const place = (p: [number, number]): [number, number] => [p[0] - x + 0.5, p[1] - y + 0.5];
  const dot = frame.measured_px || frame.true_px;
  const middle = dot ? place(dot) : [width / 2, height / 2];
  const box = windowed ? [middle[0] - kWindow / 2, middle[1] - kWindow / 2, kWindow, kWindow] : [0, 0, width, height];
  const svg = shape('svg', { viewBox: box.map((v) => v.toFixed(2)).join(' '), role: 'img', 'aria-label': 'laser frame' });
  const image = shape('image', { href: frame.image!, width, height });
  svg.append(image);
  const size = windowed ? kWindow : Math.max(width, height);
  if (frame.true_px) svg.append(...ring(...place(frame.true_px), 0.07 * size));
  if (frame.measured_px) svg.append(...cross(...place(frame.measured_px), 0.11 * size));
  stretchGreys(frame.image!, image, stretch);
  return svg;
}

/** So that the brightest of 99.9 % of the pixels is white. */
function stretchGreys(source: string, image: SVGElement, stretch: HTMLElement) {
  const picture = new Image();
  picture.onload = () => {
    const canvas = element('canvas', { width: picture.naturalWidth, height: picture.naturalHeight });
    const context = canvas.getContext('2d', { willReadFrequently: true });
    if (!context) return;
    context.drawImage(picture, 0, 0);
    const pixels = context.getImageData(0, 0, canvas.width, canvas.height);
    const levels = new Uint32Array(256);
    for (let i = 0; i < pixels.data.length; i += 4) ++levels[pixels.data[i]];
    let left = pixels.data.length / 4000, top = 255;
    while (top > 1 && left > levels[top]) left -= levels[top--];
    const gain = Math.min(12, 255 / top);
    if (gain < 1.1) { stretch.textContent = 'levels as taken'; return; }
    for (let i = 0; i < pixels.data.length; ++i) if (i % 4 !== 3) pixels.data[i] = Math.min(255, gain * pixels.data[i]);
    context.putImageData(pixels, 0, 0);
    image.setAttribute('href', canvas.toDataURL());
    stretch.textContent = 'levels \u00d7\u2009' + format.number(gain, 1);
  };
  picture.src = source;
}

// Every mark twice: dark below, coloured above, so that it stands out on black and on white.
function ring(x: number, y: number, r: number): SVGElement[] {
  return ['halo', 'true'].map((kind) => shape('circle', { cx: x, cy: y, r, class: 'dot ' + kind }));
}

function cross(x: number, y: number, r: number): SVGElement[] {
  const inner = 0.35 * r;
  const path = [[1, 0], [-1, 0], [0, 1], [0, -1]].map(([dx, dy]) =>
    'M' + (x + inner * dx) + ' ' + (y + inner * dy) + 'L' + (x + r * dx) + ' ' + (y + r * dy)).join('');
  return ['halo', 'measured'].map((kind) => shape('path', { d: path, class: 'dot ' + kind }));
}

function frameCaption(frame: Frame, number: number, stretch: HTMLElement): HTMLElement {
  const rows: HTMLElement[] = [];
  const row = (label: string, value: string) => rows.push(element('dt', {}, label), element('dd', {}, value));
  if (frame.reading_mm !== undefined) row('reading', format.quantity(frame.reading_mm, 'mm'));
  if (frame.true_gap_mm !== undefined) row('true gap', format.quantity(frame.true_gap_mm, 'mm'));
  if (frame.reading_mm !== undefined && frame.true_gap_mm !== undefined) {
    const error = 1000 * (frame.reading_mm - frame.true_gap_mm);
    row('error', (error > 0 ? '+' : '') + format.quantity(error, 'um'));
  }
  if (frame.sigma_um !== undefined) row('1 σ', format.quantity(frame.sigma_um, 'um'));
  const state = frame.used ? 'used' : 'discarded' + (frame.why ? ': ' + format.message(frame.why) : '');
  return element('figcaption', {},
    element('div', { class: 'frame-head' }, element('b', {}, '#' + number), format.quantity(frame.time_s, 's')),
    element('dl', {}, ...rows), element('p', { class: 'state' }, state), element('p', { class: 'stretch' }, stretch));
}

function enlarge(frame: Frame, number: number) {
  const stretch = element('span');
  const close = element('button', { type: 'button' }, 'Close');
  const dialog = element('dialog', { class: 'frame-large', 'aria-label': 'Frame ' + number },
    element('figure', {}, framePicture(frame, false, stretch), frameCaption(frame, number, stretch)), close);
  close.addEventListener('click', () => dialog.close());
  dialog.addEventListener('click', (event) => { if (event.target === dialog) dialog.close(); });
  dialog.addEventListener('close', () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}
