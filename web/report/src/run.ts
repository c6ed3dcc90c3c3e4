// The run along the replay's path: pose, line and figures at any instant.
import type { ReplayData } from './record';
import { lastNotAbove, unpackColumn, unpackIntegers, unpackPoses, type Poses } from './pack';

export class Run {
  readonly time: Float64Array;
  private readonly line: Float64Array;
  private readonly lineTime: Float64Array;  // from when on each line is carried out
  readonly extruding: Float64Array;
  readonly tool: Poses;
  readonly gap: Float64Array;  // [um]; NaN: nothing below
  readonly tipError: Float64Array;  // [um]
  readonly turnError: Float64Array;  // [mrad]

  constructor(data: ReplayData) {
    this.time = unpackColumn(data.path.time_s);
    this.line = unpackIntegers(data.lines.line);
    this.lineTime = unpackColumn(data.lines.time_s);
    this.extruding = unpackIntegers(data.path.extruding);
    this.tool = unpackPoses(data.path.tool);
    this.gap = unpackColumn(data.path.gap_um);
    this.tipError = unpackColumn(data.path.tip_error_um);
    this.turnError = unpackColumn(data.path.orientation_error_mrad);
  }

  get start(): number { return this.time[0]; }
  get end(): number { return this.time[this.time.length - 1]; }
  indexAt(time: number): number { return lastNotAbove(this.time, time); }
  lineAt(time: number): number { return this.line[lastNotAbove(this.lineTime, time + 1e-6)]; }

  /** Linear between points; NaN beside a missing one. */
  valueAt(values: Float64Array, time: number): number {
    const i = this.indexAt(time), j = Math.min(i + 1, values.length - 1);
    const span = this.time[j] - this.time[i];
    const share = span > 0 ? Math.min(1, Math.max(0, (time - this.time[i]) / span)) : 0;
    return share === 0 ? values[i] : values[i] + share * (values[j] - values[i]);
  }

  /** When a line of the program begins to be carried out; the next line that is, where that one moves nothing. */
  timeOfLine(line: number): number | null {
    for (let i = 0; i < this.line.length; ++i)
      if (this.line[i] >= line) return this.lineTime[i];
    return null;
  }

  speedAt(time: number): number {
    const i = Math.min(this.indexAt(time), this.time.length - 2), p = this.tool.place;
    if (i < 0) return 0;
    const span = this.time[i + 1] - this.time[i];
    return span > 0 ? Math.hypot(p[3 * i + 3] - p[3 * i], p[3 * i + 4] - p[3 * i + 1], p[3 * i + 5] - p[3 * i + 2]) / span : 0;
  }
}
