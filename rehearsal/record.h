// Everything a rehearsal found out: the data behind summary.json, trace.csv, the report and scenarios.
// Drawing is elsewhere (report/); absent values stay absent.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "control/gap/gap_controller.h"
#include "control/registration/part_fit.h"
#include "core/frames.h"
#include "core/library_versions.h"
#include "machine/port.h"
#include "rehearsal/findings/finding.h"
#include "rehearsal/observers/run_curves.h"
#include "rehearsal/replay.h"
#include "rehearsal/scene.h"

namespace understudy::sim {
struct MilledSurface;
}

namespace understudy::rehearsal {

struct PrintFigures {
  double duration_s = 0;
  int moves = 0;
  double extruded_mm = 0;   ///< filament fed: printed, purged and missing
  double printed_mm = 0;    ///< of that, laid along the path
  double purged_mm = 0;     ///< of that, fed at a standstill and left behind
  double missing_mm = 0;    ///< of that, not laid: the end of the print is in the nozzle
  double primed_mm = 0;     ///< besides: pushed back to the nozzle after retractions
  double deposited_mm = 0;  ///< of what was laid: lies on something and sticks
  double spanning_mm = 0;   ///< of what was laid: hangs in air from something that holds it
  double travel_mm = 0;     ///< of the tip, without extrusion
  /// Material over space of neighbouring lines, median (FillFigures); nothing without neighbours.
  std::optional<double> fill_factor;
};
struct AccuracyFigures {
  double tip_rms_um = 0, tip_p95_um = 0, tip_max_um = 0, orientation_max_mrad = 0, open_loop_tip_max_um = 0;
};
struct GapFigures {
  double commanded_mm = 0;
  std::optional<double> open_loop_start_mm;  ///< without gap control
  double start_mm = 0, path_min_mm = 0, path_mean_mm = 0, path_max_mm = 0, in_band_fraction = 0;
  int frames = 0;
  /// What the controller believed of it (GapBelief); nothing where it states no uncertainty.
  std::optional<double> believed_mean_mm = {},
                        stated_sigma_um = {};                 ///< the median of its 1 sigma along the path
  std::optional<double> stated_path_fraction = {};            ///< of the path for which it states one
  std::optional<double> inside_stated_3_sigma_fraction = {};  ///< of that, the true gap within 3 sigma
};
/// One twin driven by two descriptions, without gap control.
struct CalibrationFigures {
  std::string machine_before, machine_after;
  std::string not_run_before;  ///< why the description before could not run the program
  std::optional<AccuracyFigures> before;
  AccuracyFigures after;
};
/// Signed: negative is the depth of a contact. Nothing where no such pair was looked at.
struct CollisionFigures {
  std::optional<double> min_clearance_mm;  ///< of all bodies but the nozzle over its work
  std::string closest;                     ///< these two: "strut 3 and table"
  /// The nozzle to the part, or to the table where there is no part, and to printed beads where it ploughs
  /// them.
  std::optional<double> nozzle_clearance_mm;
  std::uint64_t checks = 0;
  int pairs = 0;
};
struct SagFigures {
  double max_um = 0;
  int strands = 0;
  double unsupported_mm = 0;  ///< length of all strands in air
  /// Thinnest and thickest of them, each round with the material that it has over its path.
  double diameter_min_mm = 0, diameter_max_mm = 0;
};
struct SurfaceFigures {
  std::optional<double> ra_um, rz_um;      ///< along the chosen line
  std::optional<double> deviation_p95_um;  ///< of the printed surface from the intended part
};
/// What an end mill did to a part (sim::RemovalSummary).
struct RemovalFigures {
  double spacing_mm = 0, finished_fraction = 0;
  double left_over_mean_um = 0, left_over_p95_um = 0, left_over_max_um = 0;
  double planned_left_over_p95_um = 0, planned_left_over_max_um = 0;
  double gouge_um = 0, planned_gouge_um = 0;
  std::array<double, 3> gouge_mm{0, 0, 0};  ///< where it is deepest
  int gouge_line = 0;
  double volume_mm3 = 0;
};
/// A place that the gap sensor looked at.
struct RegistrationRow {
  std::array<double, 3> place_mm{0, 0, 0};  ///< on the drawn part
  std::string why;                          ///< it was left out
  /// Where it was measured: gap read, noise of that, distance from the part as found, 1 sigma of the found
  /// part's surface there, and by how much that surface is truly off, as the tool meets it.
  std::optional<double> gap_mm, reading_sigma_um, residual_um, sigma_um, error_um;
};
/// The clamped part as the machine found it. Shift and turn are of the drawn part, the shift where the
/// reference point is.
struct RegistrationFigures {
  int places = 0, left_out = 0;
  int seen = 0;                     ///< freedoms of six
  std::vector<std::string> unseen;  ///< in words; left as drawn
  std::array<double, 3> reference_mm{}, shift_um{}, turn_mrad{}, shift_sigma_um{}, turn_sigma_mrad{};
  double chi_square = 0, chi_square_limit = 0;
  int degrees_of_freedom = 0;
  double place_sigma_um = 0;       ///< that each place was taken to be off besides the reading's noise
  double normal_sigma_max_um = 0;  ///< 1 sigma of the found surface, at the worst place
  double normal_error_max_um = 0;  ///< its true error where it was measured
  std::optional<double> normal_error_rms_um;
  double duration_s = 0;
  std::string refused;  ///< why nothing was printed; empty: it was
  std::vector<RegistrationRow> rows;
  std::optional<control::PartFit> fit;
};
/// The place on the table that was found (rehearsal/placement).
struct PlacementFigures {
  std::array<double, 3> place_mm{0, 0, 0};
  double turn_deg = 0, spin_deg = 0;
  double margin = 0;    ///< to the nearest limit: 0 at it, 1 in the middle of a range
  std::string least;    ///< the limit that is nearest
  std::string refused;  ///< why no place holds every limit; empty: this one does
  std::string words;    ///< as options of `rehearse`
};
struct EngineFigures {
  std::string name, version;
  double timestep_s = 0;
  std::uint64_t steps = 0;
  double closure_max_um = 0;
};
/// By the clock on the wall: the one part of a record that differs from run to run.
struct TimingFigures {
  double simulated_s = 0, wall_s = 0;
  std::optional<double> to_first_setpoint_s = {};  ///< from the start of the process
};
struct Provenance {
  std::string version, machine_sha256, program_sha256;
  std::uint64_t seed = 0;
  std::string as_built, command;
  std::vector<std::string> faults = {};  ///< what was made to go wrong, in words
  std::string machine_before_sha256 = {};
  std::string inputs_sha256 = {};   ///< of all inputs (input_digest.h)
  std::string fixture_sha256 = {};  ///< of the part's file; empty: without one
  LibraryVersions libraries = {};   ///< that may have a part in the result
};

/// A strand in air as the report lists it.
struct StrandRow {
  int line = 0;
  double time_s = 0, length_mm = 0, diameter_mm = 0, speed_mm_per_s = 0, sag_um = 0;
  double solid_after_s = 0, duration_s = 0;
  bool held_at_end = true, solved = true, small = true;
};

/// One instant of the run, truth beside command.
struct TracePoint {
  double time = 0;  ///< [s]
  int line = 0;
  bool extruding = false;
  Pose X_WT = Pose::Identity();  ///< true
  Pose X_WT_programmed =
      Pose::Identity();           ///< what the program asks for, without the gap controller's offset
  double tip_error = 0;           ///< [m], true against programmed
  double orientation_error = 0;   ///< [rad]
  double gap = 0;                 ///< [m], true, along the tool axis; infinity: nothing below
  double path = 0;                ///< [m] of tip path since extrusion began; 0 before
  kinematics::AxisVector axes{};  ///< SI, measured
};

/// What the controller held of the gap at one instant (gap_belief.h).
struct GapBelief {
  double gap = 0;    ///< [m]
  double sigma = 0;  ///< [m], 1 sigma as it states it; NaN: it states none
};

/// A laser frame kept for the report: the controller's look and the truth beside it.
struct FrameRecord {
  control::GapSample look;
  double true_gap = 0;  ///< [m]
  std::optional<Vec2> true_dot_px;
};

/// A column of TracePoint::axes as files and charts show it.
struct AxisColumn {
  std::string name;                ///< "l1_mm", "j1_deg": the suffix is the unit of files
  std::optional<double> min, max;  ///< SI; the axis' limits
};

struct Record {
  bool go = false;
  std::vector<Finding> findings;  ///< errors first, then by line
  std::string title;              ///< "curved-line.gcode on hexapod"
  std::string program_name, machine_name, fixture_name, gap_control;
  std::string program_word, machine_word;     ///< as the command line and `--machine` took them
  std::array<double, 3> place_mm{0, 0, 0};    ///< where the program's origin stands in W
  std::optional<PlacementFigures> placement;  ///< where the place was found, not given
  bool measures_gap = false;                  ///< the machine has laser and microscope
  /// First and last line of what was passed over, in order: the run is one without it.
  std::vector<std::pair<int, int>> passed_over;

  std::optional<PrintFigures> print;
  std::optional<AccuracyFigures> accuracy;
  std::optional<CalibrationFigures> calibration;  ///< where a machine before its calibration was asked for
  std::optional<GapFigures> gap;
  std::optional<SagFigures> sag;
  std::optional<CollisionFigures> collision;
  std::optional<SurfaceFigures> surface;
  std::optional<RemovalFigures> removal;            ///< where a stock was asked for
  std::optional<RegistrationFigures> registration;  ///< where it was asked for
  std::optional<EngineFigures> engine;
  std::optional<TimingFigures> timing;
  Provenance provenance;

  std::string as_built;  ///< every true parameter, as the file that --as-built reads
  double tip_tolerance_mm = 0, orientation_tolerance_deg = 0;  ///< beyond, a print is a no-go
  std::vector<AxisColumn> axes;  ///< the first entries of TracePoint::axes, in order
  double gap_accepted_min_mm = 0, gap_accepted_max_mm = 0, gap_aim_mm = 0;
  std::vector<TracePoint> trace;
  int trace_stride = 1;                               ///< snapshots a point of the trace
  RunCurves curves;                                   ///< over the time of the trace; may be empty
  std::vector<GapBelief> gap_beliefs;                 ///< one for each point of the trace
  std::string gap_belief_note;                        ///< where their sigma comes from, in words
  std::vector<TracePoint> trace_without_gap_control;  ///< empty when the run itself had none
  std::vector<TracePoint> trace_before_calibration;   ///< without gap control, too
  std::vector<FrameRecord> frames;
  std::vector<std::array<double, 2>> profile;        ///< position [mm], height [um] along the chosen line
  std::string profile_note, deviation_note;          ///< in words
  std::vector<StrandRow> strands;                    ///< those that sag most first
  std::shared_ptr<const sim::MilledSurface> milled;  ///< before and after; null: nothing was
  std::optional<Scene> scene;                        ///< what pictures are drawn from; where it was asked for
  std::optional<Replay> replay;                      ///< likewise: the machine along the trace
};

}  // namespace understudy::rehearsal
