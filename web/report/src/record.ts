// The data block "understudy.report/1" (docs/report-data.md), as far as the page reads it.
export interface Finding {
  kind: string; severity: 'error' | 'warning'; gcode_line?: number; time_s: number; value: number; limit: number; unit: string; message: string;
}
export interface FindingGroup {
  kind: string; severity: 'error' | 'warning'; count: number; first_line?: number; last_line?: number; worst: Finding; advice?: string;
}
export type Numbers = (number | null)[];
export interface Trace { points: number; columns: Record<string, Numbers> }
export interface Frame {
  time_s: number; used: boolean; why?: string; dot: string; measured_px?: [number, number]; true_px?: [number, number];
  reading_mm?: number; sigma_um?: number; residual_px?: number; true_gap_mm?: number;
  region?: [number, number, number, number]; image?: string;
}
export interface Column { unit: number; data: string }
export interface PoseColumns { x_mm: Column; y_mm: Column; z_mm: Column; qw: Column; qx: Column; qy: Column; qz: Column }
export interface MeshData { x_mm: Column; y_mm: Column; z_mm: Column; corners: string }
export interface Form {
  sphere_mm?: number[]; capsule_mm?: number[]; cylinder_mm?: number[]; frustum_mm?: number[]; box_mm?: number[];
  mesh?: MeshData; at_mm?: number[]; box_for_triangles?: number;
}
export interface PoseData { place_mm: number[]; turn: number[] }
export interface Body {
  name: string; form: Form; carrier: 'world' | 'tool' | 'strut' | 'axes'; pose?: PoseData; from_mm?: number[]; to_tool_mm?: number[]; poses?: PoseColumns;
}
export interface BeadData {
  beads: number; within_um: number; one_stretch_of?: number; stretches: string; x_mm: Column; y_mm: Column; z_mm: Column; up_x: Column; up_y: Column;
  up_z: Column; width_mm: Column; height_mm: Column; time_s: Column; line: string; type?: string; type_names?: string[];
}
export interface ReplayData {
  path: {
    points: number; within_um?: number; time_s: Column; extruding: string; tool: PoseColumns; gap_um: Column; tip_error_um: Column;
    orientation_error_mrad: Column;
  };
  lines: { time_s: Column; line: string }; key_time_s: Column; bodies: Body[]; machine_frame?: PoseColumns; table?: { form: Form; pose: PoseData }; part?: MeshData;
  part_left_out_triangles?: number; beads?: BeadData; program: { text: string; left_out_bytes?: number };
}
export interface SpanColumns { low: Column; high: Column }
export interface OverTime {
  begin_s: Column; end_s: Column; nozzle_c?: SpanColumns; interface_c?: SpanColumns; glass_transition_c?: number; nozzle_clearance_mm?: Column;
  drives?: ({ axis: string; unit: string } & SpanColumns)[]; flips?: { count: number; time_s: Column; axis: string };
}
export interface Summary {
  grade: 'go' | 'go-with-warnings' | 'no-go'; findings: Finding[]; finding_groups: FindingGroup[]; passed_over?: [number, number][];
  [section: string]: any;
}
export interface Report {
  schema: string; title: string; reason: string; names: Record<string, string>; summary: Summary;
  gap_band?: { min_mm: number; max_mm: number; aim_mm: number };
  axes: { name: string; min?: number; max?: number }[];
  trace?: Trace; trace_without_gap_control?: Trace; trace_before_calibration?: Trace; gap_belief_note?: string;
  over_time?: OverTime;
  strands?: any[]; profile?: { position_mm: number[]; height_um: number[]; note: string }; deviation_note?: string;
  live?: { share: number; what: string; note?: string };  // of a run that goes on
  replay?: ReplayData; frames: Frame[]; pictures: { caption?: string; width: number; height: number; image: string }[];
}

/** Of the page itself. Throws an Error with one sentence for people. */
export function readRecord(): Report { return parseRecord(document.getElementById('record')!.textContent || ''); }

export function parseRecord(text: string): Report {
  let report: Report;
  try {
    report = JSON.parse(text);
  } catch {
    throw new Error('The data of this page are damaged: the file was cut short or changed after it was written.');
  }
  if (!report || report.schema !== 'understudy.report/1')
    throw new Error('The data of this page have the schema ' + JSON.stringify(report && report.schema) + '; this page reads understudy.report/1.');
  if (!report.summary || !Array.isArray(report.summary.findings) || !report.names)
    throw new Error('The data of this page lack their summary.');
  report.frames = report.frames || [];
  report.pictures = report.pictures || [];
  report.axes = report.axes || [];
  return report;
}
