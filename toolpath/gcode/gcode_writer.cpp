#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/gcode/words/gcode_limits.h"
#include "toolpath/gcode/words/gcode_number.h"

namespace understudy::toolpath {
namespace {

std::string millimetres(double metres) { return plain_number(to_mm(metres), 6); }

class Writer {
 public:
  explicit Writer(const GcodeStyle& style) : style_(style) {}

  std::string run(const Program& program, const std::vector<std::string>& header) {
    for (std::string line : header) {
      for (char& c : line)
        if (c == '\n' || c == '\r') c = ' ';
      out_ += "; " + line + "\n";
    }
    out_ += "G21\nG90\nM82\nG94\n";
    for (const std::string& command : style_.commands) out_ += command + "\n";
    for (const Step& step : program.steps) write(step);
    return std::move(out_);
  }

 private:
  void write(const Step& step) {
    switch (step.kind) {
      case StepKind::travel:
        return line("G0" + pose(step));
      case StepKind::move:
      case StepKind::print:
        return linear(step);
      case StepKind::home:
        return line("G28");
      case StepKind::dwell:
        return line("G4 P" + plain_number(checked(step.duration) * 1e3, 6));
      case StepKind::temperature:
        return line((step.wait ? "M109 S" : "M104 S") +
                    plain_number(checked(step.temperature) - kCelsiusZero, 6));
      case StepKind::fan:
        return line(step.fan > 0 ? "M106 S" + plain_number(checked(step.fan) * 255, 6) : "M107");
      case StepKind::end:
        return line("M30");
    }
  }

  void linear(const Step& step) {
    const bool timed = step.duration > 0;
    const double per_minute = timed ? 60 / step.duration : step.feed / kMillimetrePerMinute;
    const std::string feed = plain_number(checked(per_minute), timed ? 12 : 6);
    if (feed == "0" || feed[0] == '-')
      throw InputError(
          fmt::format("step {}: a feed of {} cannot be written, it must be above 0", steps_ + 1, per_minute));
    set_timed(timed);
    std::string text = "G1" + pose(step);
    if (step.filament != 0) {
      // The reading is what is rounded, so the error does not add up over the program.
      extruder_ += checked(step.filament);
      if (std::abs(extruder_) > kLargestExtruder)
        throw InputError(fmt::format("step {}: {:.6g} mm of filament cannot be written, beyond {:.6g} mm",
                                     steps_ + 1, to_mm(extruder_), to_mm(kLargestExtruder)));
      text += fmt::format(" {}{}", style_.extruder_letter, millimetres(extruder_));
    }
    if (timed || feed != feed_) text += " F" + feed;
    feed_ = timed ? "" : feed;
    line(text);
  }

  void set_timed(bool timed) {
    if (timed != timed_) out_ += timed ? "G93\n" : "G94\n";
    timed_ = timed;
  }

  std::string pose(const Step& step) const {
    const Pose& X_WT = step.X_WT;
    if (!X_WT.matrix().allFinite())
      throw InputError(fmt::format("step {}: a pose that is not finite cannot be written", steps_ + 1));
    const Vec3 p = X_WT.translation();
    if (p.cwiseAbs().maxCoeff() > kLargestCoordinate)
      throw InputError(fmt::format("step {}: ({:g}, {:g}, {:g}) mm cannot be written, beyond {:g} mm",
                                   steps_ + 1, to_mm(p.x()), to_mm(p.y()), to_mm(p.z()),
                                   to_mm(kLargestCoordinate)));
    return fmt::format(" X{} Y{} Z{}", millimetres(p.x()), millimetres(p.y()), millimetres(p.z())) +
           (step.rotary && !style_.turn_letters.empty() ? turns(*step.rotary) : orientation(X_WT.linear()));
  }

  static std::string orientation(const Mat3& R_WT) {
    Quat q(R_WT);
    if (q.w() < 0) q.coeffs() *= -1;
    return fmt::format(" W{} I{} J{} K{}", plain_number(q.w(), 9), plain_number(q.x(), 9),
                       plain_number(q.y(), 9), plain_number(q.z(), 9));
  }

  std::string turns(const RotaryTurns& turns) const {
    std::string text;
    for (std::size_t i = 0; i < style_.turn_letters.size(); ++i)
      text += fmt::format(" {}{}", style_.turn_letters[i],
                          plain_number(checked(i == 0 ? turns.b : turns.c) / style_.turn_units.at(i), 6));
    return text;
  }

  double checked(double value) const {
    if (!std::isfinite(value))
      throw InputError(fmt::format("step {}: {} cannot be written, it is not finite", steps_ + 1, value));
    return value;
  }

  void line(const std::string& text) {
    out_ += text + "\n";
    ++steps_;
  }

  const GcodeStyle& style_;
  std::string out_;
  double extruder_ = 0;  // [m]
  bool timed_ = false;
  std::string feed_;  // as last written under G94
  std::size_t steps_ = 0;
};

}  // namespace

std::string write_gcode(const Program& program, const std::vector<std::string>& header,
                        const GcodeStyle& style) {
  return Writer(style).run(program, header);
}

}  // namespace understudy::toolpath
