// Columns as report/page/pack.h writes them.
import { unzlibSync } from 'fflate';
import type { Column, PoseColumns } from './record';

const kNone = 2 ** 40;  // a value that is missing

function inflate(base64: string): Uint8Array {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return unzlibSync(bytes);
}

export function unpackText(base64: string): string { return new TextDecoder().decode(inflate(base64)); }

/** Differences of neighbours, zigzag, seven bits a byte. Numbers stay below 2^53, which doubles hold. */
export function unpackIntegers(base64: string): Float64Array {
  const bytes = inflate(base64);
  let count = 0;
  for (const byte of bytes) if (byte < 0x80) ++count;
  const values = new Float64Array(count);
  let last = 0, at = 0;
  for (let i = 0; i < count; ++i) {
    let rest = 0, scale = 1, byte: number;
    do {
      byte = bytes[at++];
      rest += (byte & 0x7f) * scale;
      scale *= 128;
    } while (byte >= 0x80);
    last += rest % 2 === 0 ? rest / 2 : -(rest + 1) / 2;
    values[i] = last;
  }
  return values;
}

export function unpackColumn(column: Column): Float64Array {
  const values = unpackIntegers(column.data);
  for (let i = 0; i < values.length; ++i) values[i] = values[i] === kNone ? NaN : values[i] * column.unit;
  return values;
}

/** Poses, one an instant: place in mm, turn as x y z w. */
export interface Poses { place: Float64Array; turn: Float64Array; count: number }

export function unpackPoses(data: PoseColumns): Poses {
  const interleave = (columns: Float64Array[]) => {
    const all = new Float64Array(columns.length * columns[0].length);
    columns.forEach((column, c) => column.forEach((value, i) => { all[i * columns.length + c] = value; }));
    return all;
  };
  const place = interleave([data.x_mm, data.y_mm, data.z_mm].map(unpackColumn));
  return { place, turn: interleave([data.qx, data.qy, data.qz, data.qw].map(unpackColumn)), count: place.length / 3 };
}

/** The last index whose value is not above `value`, from sorted values; 0 where all are. */
export function lastNotAbove(sorted: ArrayLike<number>, value: number): number {
  let low = 0, high = sorted.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (sorted[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return Math.max(0, low - 1);
}
