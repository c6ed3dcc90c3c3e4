// One colour for one meaning (docs/design.md), and scales that colour-blind eyes can read: cividis for more and less, blue to brown about a
// band, Okabe and Ito's set for kinds.
export type Rgb = [number, number, number];

const kCividis: Rgb[] = [[0, 34, 78], [18, 53, 112], [59, 73, 108], [87, 93, 109], [112, 113, 115], [138, 134, 120], [165, 156, 116], [195, 179, 105], [225, 204, 85], [254, 232, 56]];
export const kKinds: Rgb[] = [[150, 150, 150], [0, 114, 178], [230, 159, 0], [0, 158, 115], [204, 121, 167], [86, 180, 233], [213, 94, 0], [240, 228, 66], [90, 90, 90]];
export const kPlastic: Rgb = [226, 126, 66];
const kTooNear: Rgb = [0, 84, 148], kInBand: Rgb = [214, 214, 206], kTooFar: Rgb = [163, 82, 0];
export const kUnknown: Rgb = [128, 128, 128];

function mix(a: Rgb, b: Rgb, share: number): Rgb { return [0, 1, 2].map((i) => a[i] + share * (b[i] - a[i])) as Rgb; }

/** 0 dark, 1 bright. */
export function cividis(share: number): Rgb {
  const at = Math.min(1, Math.max(0, share)) * (kCividis.length - 1);
  const i = Math.min(kCividis.length - 2, Math.floor(at));
  return mix(kCividis[i], kCividis[i + 1], at - i);
}

/** Grey inside the band; blue below and brown above, full at a band's width beside it. */
export function aboutBand(value: number, low: number, high: number): Rgb {
  const width = high - low;
  if (value < low) return mix(mix(kInBand, kTooNear, 0.45), kTooNear, Math.min(1, (low - value) / width));
  if (value > high) return mix(mix(kInBand, kTooFar, 0.45), kTooFar, Math.min(1, (value - high) / width));
  return kInBand;
}

export function css(colour: Rgb): string { return 'rgb(' + colour.map((c) => Math.round(c)).join(' ') + ')'; }

/** A colour of the style sheet, by its name there. */
export function styleColour(name: string): string { return getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim(); }
