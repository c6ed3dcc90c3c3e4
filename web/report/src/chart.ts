// What a chart is made of, and the scale that shows nearly all of it.
import { format } from './format';

export interface Curve { label: string; colour: string; dash?: number[]; width?: number; x: number[]; y: (number | null | undefined)[] }
export interface Chart {
  title: string; note: string; curves: Curve[]; unit: string; decimals: number; xLabel: string; yLabel: string; range?: [number, number];
  band?: [number, number]; belief?: { x: number[]; low: (number | null)[]; high: (number | null)[] }; lines?: { at: number; colour: string; dash: number[] }[];
  ticks?: { time: number; colour: string }[]; log?: boolean; onPath?: boolean; ofSurface?: boolean; before?: Node | null;
}

export const kAxisColours = ['curve-1', 'curve-2', 'curve-3', 'curve-4', 'curve-5', 'curve-6', 'curve-7', 'curve-8'];

/** What holds nearly all of the values: a few spikes do not flatten the rest. `note` says what is beyond. */
export function nearlyAll(curves: Curve[], include: number[]): { range: [number, number]; beyond: number } {
  const values = curves.flatMap((curve) => curve.y).filter((y): y is number => typeof y === 'number' && isFinite(y)).sort((a, b) => a - b);
  if (!values.length) return { range: [0, 1], beyond: 0 };
  const at = (share: number) => values[Math.min(values.length - 1, Math.floor(share * values.length))];
  let low = Math.min(...include, values[0]), high = Math.max(...include, values[values.length - 1]);
  const [from, to] = [Math.min(...include, at(0.01)), Math.max(...include, at(0.99))];
  const span = to - from || 1;
  if (high > to + 1.5 * span) high = to;
  if (low < from - 1.5 * span) low = from;
  const pad = 0.06 * (high - low || 1);
  return { range: [low === 0 ? 0 : low - pad, high + pad], beyond: values.filter((v) => v > high || v < low).length };
}

export function beyondNote(beyond: number): string { return beyond ? ' ' + format.plural(beyond, 'sample') + ' beyond the scale.' : ''; }
