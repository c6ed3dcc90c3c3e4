// Numbers, units and words as the page writes them.
export const format = {
  // Decimals by unit: a tenth of what matters in that unit.
  decimals: { mm: 3, um: 1, mrad: 3, deg: 2, s: 2, 'mm/s': 2, px: 2 } as Record<string, number>,

  unit(unit: string): string { return unit === 'um' ? 'µm' : unit === 'deg' ? '°' : unit === '1' ? '' : unit.replace('/s2', '/s²'); },

  // Columns and keys end in their unit: gap.start_mm, l1_mm, duration_s.
  unitOfKey(key: string): string {
    const match = /_(mm|um|mrad|deg|s)$/.exec(key);
    return match ? match[1] : '';
  },

  number(value: number, decimals: number): string {
    const text = value.toFixed(decimals);
    return (/^-0(\.0*)?$/.test(text) ? text.slice(1) : text).replace('-', '\u2212');
  },

  quantity(value: number | null | undefined, unit: string): string {
    if (typeof value !== 'number' || !isFinite(value)) return '\u2013';
    if (!(unit in format.decimals)) {
      const plain = Number(value.toPrecision(4)).toString().replace('-', '\u2212');
      return unit && unit !== '1' ? plain + '\u00a0' + format.unit(unit) : plain;
    }
    // Four figures are enough for people; the files carry more.
    const magnitude = Math.floor(Math.log10(Math.abs(value) || 1));
    const least = value !== 0 && magnitude < 0 ? Math.min(4, 1 - magnitude) : 0;
    const decimals = Math.max(0, least, Math.min(format.decimals[unit], 3 - magnitude));
    const gap = unit === 'deg' ? '' : '\u00a0';
    return format.number(value, decimals) + gap + format.unit(unit);
  },

  // As given, 0.1 stays 0.1, but to no more decimals than the unit has.
  given(value: number, unit: string): string { return String(Number(value.toFixed(format.decimals[unit] ?? 3))).replace('-', '\u2212'); },

  range(low: number, high: number, unit: string): string { return format.given(low, unit) + '\u2013' + format.given(high, unit) + '\u00a0' + format.unit(unit); },

  count(value: number): string { return String(value).replace(/\B(?=(\d{3})+(?!\d))/g, '\u202f'); },

  // Rounded down: 100.0 % means all of it.
  percent(fraction: number): string { return format.number(Math.floor(1000 * fraction + 1e-6) / 10, 1) + '\u00a0%'; },

  plural(count: number, noun: string): string { return count + ' ' + noun + (count === 1 ? '' : 's'); },

  // Messages come from the program with plain letters for units.
  message(text: string): string { return text.replace(/(\d)\s*um\b/g, '$1\u00a0µm').replace(/(\d) (mm|deg|mrad|s)\b/g, '$1\u00a0$2'); },

  kind(kind: string): string { return kind.replace(/_/g, ' '); },
};
