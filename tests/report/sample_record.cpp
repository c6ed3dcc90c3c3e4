#include "tests/report/sample_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "core/units.h"

namespace understudy::report {
namespace {

using namespace rehearsal;

constexpr double kPrintSpeed = 5e-3;    // [m/s]
constexpr double kPrintLength = 60e-3;  // [m]
constexpr double kApproachTime = 6.0;   // [s]
constexpr double kSample = 2e-3;        // [s]

Pose pose_on_arc(double fraction) {
  const double angle = from_deg(-20 + 40 * std::clamp(fraction, 0.0, 1.0));
  const Quat q(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  return make_pose(q, Vec3(15.5e-3 * std::sin(angle), 0, 40e-3 + 15.5e-3 * std::cos(angle)));
}

TracePoint point_at(double time, double gap_offset, double wobble) {
  TracePoint point;
  point.time = time;
  const double s = std::max(0.0, time - kApproachTime) * kPrintSpeed;
  const double f = s / kPrintLength;
  point.extruding = time >= kApproachTime;
  point.path = s;
  point.line = point.extruding ? 14 + static_cast<int>(f * 81) : 12;
  point.X_WT_programmed = pose_on_arc(f);
  const double ripple = wobble * (12e-6 * std::sin(40 * f) + 8e-6 * std::sin(211 * f + 1));
  const double standoff = point.extruding ? 0 : 2e-3 * (1 - time / kApproachTime);
  point.gap = gap_offset + 22e-6 * std::cos(5 * f) + ripple + standoff;
  if (time < 0.5) point.gap = std::numeric_limits<double>::infinity();
  point.tip_error = std::abs(gap_offset - 0.13e-3) + 60e-6 + 45e-6 * f * f + std::abs(ripple);
  point.orientation_error = 1.2e-3 + 0.4e-3 * f;
  point.X_WT = point.X_WT_programmed;
  point.X_WT.translation() += point.tip_error * tool_axis(point.X_WT_programmed);
  for (int i = 0; i < 6; ++i)
    point.axes[static_cast<std::size_t>(i)] = 0.196 + 0.021 * std::sin(2 * f - 1 + i * std::numbers::pi / 3);
  return point;
}

std::vector<TracePoint> sample_trace(double gap_offset, double wobble) {
  std::vector<TracePoint> trace;
  const double end = kApproachTime + kPrintLength / kPrintSpeed;
  for (int i = 0; i * kSample <= end; ++i) trace.push_back(point_at(i * kSample, gap_offset, wobble));
  return trace;
}

/// Struts that swing about what they carry, two of them across zero; a nozzle that warms up and comes down.
RunCurves sample_curves() {
  RunCurves curves;
  curves.glass_transition = kCelsiusZero + 60;
  const double end = kApproachTime + kPrintLength / kPrintSpeed;
  for (int i = 0; i < 900; ++i) {
    CurveStretch stretch;
    stretch.begin = end * i / 900;
    stretch.end = end * (i + 0.95) / 900;
    for (std::size_t strut = 0; strut < 6; ++strut) {
      const double phase = static_cast<double>(strut) * std::numbers::pi / 3;
      const double load = (strut < 2 ? 0.3 : 2.5) + 1.6 * std::sin(0.9 * stretch.begin + phase);
      stretch.force[strut].add(load - 0.1);
      stretch.force[strut].add(load + 0.1);
    }
    stretch.nozzle_temperature.add(kCelsiusZero + 230);
    const TracePoint point = point_at(stretch.begin, 0.131e-3, 1);
    if (point.extruding && i % 2 == 0)
      stretch.interface_temperature.add(kCelsiusZero + 128 + 4 * std::sin(point.time));
    if (std::isfinite(point.gap)) stretch.nozzle_clearance.add(point.gap - 3e-6);
    curves.stretches.push_back(stretch);
  }
  for (int i = 0; i < 5; ++i) curves.flips.push_back({1.9 + 3.5 * i, i % 2});
  curves.flip_count = 5;
  return curves;
}

FrameRecord sample_frame(int index, double gap, Random& random) {
  FrameRecord frame;
  const Vec2 dot(300 + 90 * gap / 1e-3, 240 + 110 * gap / 1e-3);
  Image& image = frame.look.frame.image;
  image.region = {static_cast<int>(dot.x()) - 70, static_cast<int>(dot.y()) - 60, 128, 128};
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      const double r2 = std::pow(x + image.region.x - dot.x(), 2) + std::pow(y + image.region.y - dot.y(), 2);
      const double speckle = -std::log(1 - random.uniform());
      const double level = 26 + 3 * random.normal() + 190 * std::exp(-2 * r2 / 64) * speckle;
      image.pixels.push_back(static_cast<std::uint8_t>(std::clamp(level, 0.0, 255.0)));
    }
  frame.look.time = 0.6 + 0.42 * index;
  frame.look.used = true;
  frame.look.dot.status = vision::DotStatus::ok;
  frame.look.dot.position_px = dot + Vec2(0.4 * random.normal(), 0.4 * random.normal());
  frame.look.reading.gap = gap + 4e-6 * random.normal();
  frame.look.reading.sigma = 4.1e-6;
  frame.look.reading.residual_px = 0.6;
  frame.true_gap = gap;
  frame.true_dot_px = dot;
  return frame;
}

std::vector<FrameRecord> sample_frames() {
  std::vector<FrameRecord> frames;
  Random random(7, "sample frames");
  const double gaps[] = {2.0e-3,  1.31e-3, 0.86e-3, 0.57e-3, 0.57e-3,
                         0.38e-3, 0.26e-3, 0.19e-3, 0.15e-3, 0.131e-3};
  for (int i = 0; i < 10; ++i) frames.push_back(sample_frame(i, gaps[i], random));
  frames[3].look.used = false;
  frames[3].look.why = "saturated: 6.1 % of the spot's pixels are at 255, more than 2.0 %";
  frames[3].look.dot.status = vision::DotStatus::saturated;
  frames[3].look.reading = {};
  return frames;
}

renderer::Picture sample_picture(int shade) {
  renderer::Picture picture{640, 480, {}};
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const bool part = std::hypot(x - 320, y - 330) < 120;
      for (const int tone : {part ? 90 : 235, part ? 130 : 238, part ? 165 + shade : 240})
        picture.rgb.push_back(static_cast<std::uint8_t>(std::max(0, tone - y / 16)));
    }
  return picture;
}

Record base_record() {
  Record record;
  record.title = "curved-line.gcode on hexapod";
  record.program_name = "curved-line.gcode";
  record.machine_name = "hexapod";
  record.fixture_name = "bottle.stl";
  record.gap_control = "start";
  record.provenance = {
      "0.1.0",
      "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
      "60303ae22b998861bce3b28f33eec1be758a213c86c93c076dbe9f558c11c752",
      12345678901234567890u,
      "sampled",
      "understudy rehearse models/bottle/curved-line.gcode --machine hexapod --as-built sampled --seed 1"};
  for (int i = 1; i <= 6; ++i) record.axes.push_back({"l" + std::to_string(i) + "_mm", 0.170, 0.240});
  record.gap_accepted_min_mm = 0.1;
  record.gap_accepted_max_mm = 0.2;
  record.gap_aim_mm = 0.13;
  record.tip_tolerance_mm = 0.5;
  record.orientation_tolerance_deg = 2;
  return record;
}

void add_run(Record& record) {
  record.print = PrintFigures{18.0021, 84, 4.71234567, 4.6, 0.1, 0.01234567, 2.0, 4.5, 0.1, 412.5, 0.98};
  record.accuracy = AccuracyFigures{88.123456, 109.4, 121.987654, 1.6, 431.25};
  record.gap = GapFigures{0.13, 0.412345678, 0.1312345, 0.101, 0.1288, 0.1611, 0.9925, 10};
  record.collision = CollisionFigures{1.8412, "heater block and part", 0.1011, 184211, 31};
  record.engine = EngineFigures{"mujoco", "2.2.2", 0.0005, 36004, 0.071};
  record.timing = TimingFigures{18.002, 1.25};
  record.frames = sample_frames();
}

}  // namespace

std::vector<Illustration> sample_pictures() {
  return {illustration(sample_picture(0), "The machine at the end of the program"),
          illustration(sample_picture(60), "The nozzle above the part")};
}

Record sample_go() {
  Record record = base_record();
  record.go = true;
  add_run(record);
  record.trace = sample_trace(0.131e-3, 1);
  record.curves = sample_curves();
  record.trace_without_gap_control = sample_trace(0.412e-3, 1.6);
  record.findings = {{"near_collision", Severity::warning, 57, 11.42, 1.8412, 2.0, "mm",
                      "the heater block passes the bottle at 1.84 mm, nearer than 2.00 mm"}};
  return record;
}

Record sample_no_go() {
  Record record = base_record();
  add_run(record);
  record.trace = sample_trace(0.231e-3, 4);
  record.curves = sample_curves();
  record.trace_without_gap_control = sample_trace(-0.052e-3, 1.6);
  record.gap->start_mm = 0.2533;
  record.gap->in_band_fraction = 0.31;
  for (int i = 0; i < 27; ++i)
    record.findings.push_back({i % 3 ? "gap" : "adhesion", Severity::error, 14 + 3 * i, 6.1 + 0.43 * i,
                               0.2011 + 0.0021 * i, 0.2, "mm",
                               "the bead is laid at a gap of 0.2" + std::to_string(10 + i) +
                                   " mm, above 0.200 mm: it does not stick"});
  for (int i = 0; i < 3; ++i)
    record.findings.push_back({"axis_velocity", Severity::warning, 20 + i, 7.0 + i, 11.4, 12, "mm/s",
                               "strut " + std::to_string(i + 1) + " runs at 11.4 mm/s, 95 % of its limit"});
  return record;
}

Record sample_without_gap_control() {
  Record record = sample_go();
  record.gap_control = "off";
  record.trace = sample_trace(0.412e-3, 1.6);
  record.curves = {};  // as an older version wrote it
  record.trace_without_gap_control.clear();
  record.frames.clear();
  record.go = false;
  record.gap->open_loop_start_mm.reset();
  record.gap->start_mm = 0.4123;
  record.gap->in_band_fraction = 0;
  record.findings = {{"adhesion", Severity::error, 14, 6.0, 0.4123, 0.2, "mm",
                      "the bead is laid at a gap of 0.412 mm, above 0.200 mm: it does not stick"}};
  return record;
}

Record sample_stopped_by_constraints() {
  Record record = base_record();
  record.findings = {{"strut_length", Severity::error, 1187, 41.2, 241.7, 240.0, "mm",
                      "strut 3 is 241.7 mm, longer than 240.0 mm"},
                     {"joint_angle", Severity::error, 1192, 41.9, 63.1, 60.0, "deg",
                      "ball joint 2 is at 63.1 deg, above 60.0 deg"}};
  return record;
}

}  // namespace understudy::report
