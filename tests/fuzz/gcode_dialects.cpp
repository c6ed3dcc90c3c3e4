#include "tests/fuzz/gcode_dialects.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "tests/fuzz/reader.h"
#include "toolpath/duration.h"

namespace understudy::fuzz {
namespace {

using toolpath::GcodeOptions;
using toolpath::Program;
using toolpath::RotaryWords;
using toolpath::Step;
using toolpath::StepKind;
using Coordinates = RotaryWords::Coordinates;

Mat3 table_turn(double b, double c) {
  return (Eigen::AngleAxisd(c, Vec3::UnitZ()) * Eigen::AngleAxisd(b, Vec3::UnitY())).toRotationMatrix();
}

/// A table whose tilting axis runs 40 mm below the origin.
GcodeOptions rotary_table(Coordinates coordinates) {
  const Vec3 centre(0, 0, -0.04);
  RotaryWords words;
  words.coordinates = coordinates;
  words.tip_pose = [](const Vec3& p, double b, double c) { return make_pose(table_turn(b, c), p); };
  words.slides_pose = [centre](const Vec3& slides, double b, double c) {
    const Mat3 R = table_turn(b, c);
    return make_pose(R, Vec3(centre + R * (slides - centre)));
  };
  words.slides = [centre](const Vec3& p, double b, double c) {
    return Vec3(centre + table_turn(b, c).transpose() * (p - centre));
  };
  GcodeOptions options;
  options.X_WT_home = make_pose(Mat3(Mat3::Identity()), Vec3(0, 0, 0.05));
  options.rotary = words;
  return options;
}

std::vector<Dialect> make_dialects() {
  GcodeOptions printer;
  printer.X_WT_home = make_pose(Quat(0.8, 0, 0.6, 0), Vec3(0.01, -0.02, 0.05));
  GcodeOptions filament_on_a = printer;
  filament_on_a.extruder_letter = 'A';
  filament_on_a.offset_W = {0.01, 0.02, -0.03};
  GcodeOptions crossing = rotary_table(Coordinates::crossing);
  crossing.b_sign = crossing.c_sign = -1;
  crossing.offset_W = {0, 0, -0.04};
  std::vector<Dialect> all{{"printer", printer},
                           {"filament on A", filament_on_a},
                           {"tip", rotary_table(Coordinates::tip)},
                           {"slides", rotary_table(Coordinates::machine)},
                           {"crossing axes", crossing}};
  for (Dialect& dialect : all) dialect.options.chords_max = kChords;
  return all;
}

// What is written has 1e-6 mm, 1e-9 of a quaternion, 1e-6 mm/min or 1e-12 per minute: half of the last digit.
constexpr double kLength = 0.51e-9;  // [m]
constexpr double kTurn = 2.1e-9;     // [rad], of four components
constexpr double kRounding = 1e-12;  // relative, of doubles on the way

/// Filament at rest is paced by its own length; a path shorter than the digits is rest.
bool may_be_at_rest(const Step& step, const Pose& before) {
  return (step.X_WT.translation() - before.translation()).norm() < 4 * kLength;
}

void check_pace(const Step& read, const Step& written, bool at_rest, const std::string& where) {
  if (at_rest && written.filament != 0) return;
  require_near(read.feed, written.feed, 0.51e-6 * kMillimetrePerMinute, kRounding, where + "feed");
  if (written.kind == StepKind::dwell || written.duration <= 0)
    return require_near(read.duration, written.duration, 0.51e-9, kRounding, where + "duration");
  require_near(60 / read.duration, 60 / written.duration, 0.51e-12, kRounding, where + "moves per minute");
}

void check_same(const Program& read, const Program& written, const Pose& X_WT_home) {
  require(read.steps.size() == written.steps.size(),
          fmt::format("{} steps came back as {}", written.steps.size(), read.steps.size()));
  Pose before = X_WT_home;
  double fed = 0;  // [m], largest reading: its rounding is that of every difference
  for (std::size_t i = 0; i < read.steps.size(); ++i) {
    const Step &r = read.steps[i], &w = written.steps[i];
    const std::string where = fmt::format("step {}, line {}: ", i + 1, w.line);
    fed += std::abs(w.filament);
    const double filament = 2 * kLength + kRounding * fed;
    require(r.kind == w.kind || std::abs(w.filament) <= filament, where + "another kind of step came back");
    require_near((r.X_WT.translation() - w.X_WT.translation()).cwiseAbs().maxCoeff(), 0, kLength, 0,
                 where + "tip");
    require_near(angle_between(r.X_WT.linear(), w.X_WT.linear()), 0, kTurn, 0, where + "turn");
    require_near(r.filament, w.filament, filament, 0, where + "filament");
    check_pace(r, w, may_be_at_rest(w, before), where);
    require_near(r.temperature, w.temperature, 0.51e-6, kRounding, where + "temperature");
    require(r.wait == w.wait, where + "wait");
    require_near(r.fan, w.fan, 0.51e-6 / 255, kRounding, where + "fan");
    before = w.X_WT;
  }
}

}  // namespace

const std::vector<Dialect>& dialects() {
  static const std::vector<Dialect> all = make_dialects();
  return all;
}

void check_program(const Program& program, const GcodeOptions& options) {
  Vec3 before = options.X_WT_home.translation();
  for (const Step& step : program.steps) {
    const std::string where = fmt::format("line {}: ", step.line);
    require_finite(step.X_WT, where + "pose");
    require_finite(std::vector{step.feed, step.duration, step.filament, step.temperature, step.fan}, where);
    const double least = least_duration(step, before);
    require(least >= 0, fmt::format("{}takes {} s", where, least));
    before = step.X_WT.translation();
  }
  std::string text;
  try {
    text = write_gcode(program, {"written", "by two\nlines"});
  } catch (const InputError&) {
    return;  // of a program that has a step which G-code cannot say
  }
  GcodeOptions plain;
  plain.X_WT_home = options.X_WT_home;
  check_same(parse_gcode(text, "written.gcode", plain), program, options.X_WT_home);
}

}  // namespace understudy::fuzz
