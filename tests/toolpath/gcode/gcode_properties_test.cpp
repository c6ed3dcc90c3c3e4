// Programs that mean the same read as the same, however they are written.
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/units.h"
#include "tests/property.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using property::magnitude;
using property::real;
using property::whole;

const GcodeOptions kOptions{make_pose(Quat(0.8, 0, 0.6, 0), Vec3(0.01, -0.02, 0.05))};

Program drawn_program() {
  Program program;
  Pose at = kOptions.X_WT_home;
  for (int n = *rc::gen::inRange(1, 60); n >= 0; --n) {
    Step step;
    step.kind = n == 0 ? StepKind::travel : static_cast<StepKind>(*whole(0, 6));
    const bool moving = step.kind <= StepKind::print && *whole(0, 3) > 0;
    if (step.kind == StepKind::home) at = kOptions.X_WT_home;
    if (moving) at.translation() = *property::vector(*magnitude(1e-3, 90));
    if (moving && *whole(0, 2) > 0) at.linear() = exp_rotation(*property::vector(1.8));
    step.X_WT = at;
    if (step.kind == StepKind::print) step.filament = *magnitude(1e-8, 1);
    if (step.kind == StepKind::move && *whole(0, 2) == 0) step.filament = -*magnitude(1e-8, 1);
    if (step.kind == StepKind::move || step.kind == StepKind::print) {
      // At rest the reader tells the time that the filament takes.
      const bool timed = !moving || *whole(0, 2) == 0;
      (timed && step.filament != 0 ? step.duration : step.feed) = *magnitude(1e-4, 10);
    }
    if (step.kind == StepKind::dwell) step.duration = *magnitude(1e-6, 1e4);
    if (step.kind == StepKind::temperature)
      step.temperature = *real(273.15, 600), step.wait = *whole(0, 1) == 1;
    if (step.kind == StepKind::fan) step.fan = *real(0, 1);
    program.steps.push_back(step);
  }
  return program;
}

/// Lengths and angles in [m] and [rad]: what may differ.
void same(const Program& read, const Program& expected, double lengths, double turns) {
  RC_ASSERT(read.steps.size() == expected.steps.size());
  for (std::size_t i = 0; i < read.steps.size(); ++i) {
    const Step &r = read.steps[i], &e = expected.steps[i];
    RC_LOG() << "step " << i << "\n";
    RC_ASSERT(static_cast<int>(r.kind) == static_cast<int>(e.kind));
    RC_ASSERT((r.X_WT.translation() - e.X_WT.translation()).cwiseAbs().maxCoeff() <= lengths);
    RC_ASSERT(angle_between(r.X_WT.linear(), e.X_WT.linear()) <= turns);
    RC_ASSERT(std::abs(r.filament - e.filament) <= 2 * lengths);
    RC_ASSERT(std::abs(r.feed - e.feed) <= 0.51e-6 * kMillimetrePerMinute);
    // 12 decimals of 60 / s, or 1e-6 ms.
    RC_ASSERT(std::abs(r.duration - e.duration) <= 1e-9 + 1e-13 / 60 * e.duration * e.duration);
    RC_ASSERT(std::abs(r.temperature - e.temperature) <= 0.51e-6);
    RC_ASSERT(r.wait == e.wait);
    RC_ASSERT(std::abs(r.fan - e.fan) <= 0.51e-6 / 255);
  }
}

// Half of the last printed digit, 1e-6 mm and 1e-9 of a quaternion, and rounding at 90 m.
TEST(GcodeProperties, WhatIsWrittenIsReadBack) {
  property::check({300, 60}, [] {
    const Program written = drawn_program();
    const std::string text = write_gcode(written, {"a header"});
    RC_LOG() << text;
    const Program read = parse_gcode(text, "p", kOptions);
    same(read, written, 0.52e-9, 2.1e-9);
    same(parse_gcode(write_gcode(read, {}), "again", kOptions), read, 1e-12, 4e-9);
  });
}

struct Target {
  Vec3 p_mm;
  double fed_mm;  ///< in this line
  int feed;       ///< [mm/min]
};

/// One program in the words of one of many slicers.
struct Style {
  bool inches = *whole(0, 1) == 1, relative = *whole(0, 1) == 1, relative_filament = *whole(0, 1) == 1;
  bool lower_case = *whole(0, 1) == 1, numbered = *whole(0, 1) == 1, comments = *whole(0, 1) == 1;
  bool blanks = *whole(0, 1) == 1, modal = *whole(0, 1) == 1, crlf = *whole(0, 1) == 1;
  bool letters_turned = *whole(0, 1) == 1, shifted = *whole(0, 1) == 1;

  std::string text(const std::vector<Target>& targets) const {
    const double unit = inches ? 25.4 : 1;
    const Vec3 start = kOptions.X_WT_home.translation() * 1e3;
    Vec3 before = start, shift(0, 0, 0);
    std::string out;
    const auto line = [&](const std::string& words) {
      if (numbered) out += fmt::format("N{} ", out.size());
      for (const char c : words) {
        if (c == ' ' && !blanks) continue;
        out += lower_case ? static_cast<char>(std::tolower(static_cast<unsigned char>(c))) : c;
      }
      if (comments) out += " (G1 X1) ; G28 (and";
      out += crlf ? "\r\n" : "\n";
    };
    line(inches ? "G20" : "G21");
    line(relative_filament ? "M83" : "M82");
    if (shifted) {
      shift = Vec3(3, -7, 11);
      line(fmt::format("G92 X{:.9f} Y{:.9f} Z{:.9f}", (start.x() + shift.x()) / unit,
                       (start.y() + shift.y()) / unit, (start.z() + shift.z()) / unit));
    }
    line(relative ? "G91" : "G90");
    const bool counts_on = relative_filament || relative;
    double fed = 0;
    bool first = true;
    for (const Target& target : targets) {
      const Vec3 said = (target.p_mm - (relative ? before : Vec3(-shift))) / unit;
      fed += target.fed_mm;
      const std::string filament = fmt::format(" E{:.9f}", (counts_on ? target.fed_mm : fed) / unit);
      const std::string xyz = fmt::format(" X{:.9f} Y{:.9f} Z{:.9f}", said.x(), said.y(), said.z());
      const std::string feed = fmt::format(" F{:.9f}", target.feed / unit);
      const std::string words = letters_turned ? feed + filament + xyz : xyz + filament + feed;
      line(modal && !first ? words.substr(1) : "G1" + words);
      first = false;
      before = target.p_mm;
    }
    return out;
  }
};

TEST(GcodeProperties, UnitsModesOrderCaseBlanksAndCommentsChangeNothing) {
  property::check({500, 40}, [] {
    std::vector<Target> targets;
    for (int n = *rc::gen::inRange(1, 20); n > 0; --n)
      targets.push_back({*property::vector(200), *real(0.001, 5), *whole(1, 9000)});
    const std::string text = Style{}.text(targets);
    RC_LOG() << text;
    const Program read = parse_gcode(text, "p", kOptions);
    RC_ASSERT(read.steps.size() == targets.size());
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const Step& step = read.steps[i];
      // Nine decimals of an inch, added up over twenty lines.
      RC_ASSERT((step.X_WT.translation() * 1e3 - targets[i].p_mm).cwiseAbs().maxCoeff() < 1e-6);
      RC_ASSERT(step.kind == StepKind::print);
      RC_ASSERT(std::abs(to_mm(step.filament) - targets[i].fed_mm) < 1e-6);
      RC_ASSERT(std::abs(step.feed / kMillimetrePerMinute - targets[i].feed) < 1e-6);
      RC_ASSERT(angle_between(step.X_WT.linear(), kOptions.X_WT_home.linear()) < 1e-7);
    }
  });
}

}  // namespace
}  // namespace understudy::toolpath
