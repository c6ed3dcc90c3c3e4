// From what a robot's program does to the steps of a print.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/units.h"
#include "toolpath/bead.h"
#include "toolpath/robot/robot_path.h"

namespace understudy::toolpath {
namespace {

using Kind = RobotMove::Kind;
constexpr double kClearlyDown = 0.8;  // of the mean direction: within 37 degrees
constexpr const char* kAlways = "ALWAYS";

std::string upper(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

/// OUT[1] and $OUT[1] are one.
std::string output_key(const std::string& name) {
  std::string key = upper(name);
  if (key.starts_with('$')) key.erase(0, 1);
  return key;
}

bool is_move(const RobotMove& move) { return move.kind == Kind::straight || move.kind == Kind::free; }

/// The outputs that feed filament, and what they feed.
class Extruder {
 public:
  Extruder(const RobotPath& path, const RobotOptions& options) : path_(path), options_(options.extruder) {
    choose(options.unknown != nullptr);
    for (const int output : chosen_)
      (path.facts.outputs[static_cast<std::size_t>(output)].analogue ? analogue_ : switched_) = output;
    if (none()) return;
    if (!options_.bead_area && !options_.flow_per_unit)
      fail(fmt::format(
          "{} feeds filament, but how much the program does not say: add --bead WIDTHxHEIGHT in mm, "
          "or --flow with mm3/s for a signal of 1",
          fmt::join(names(), " with ")));
  }

  bool none() const { return chosen_.empty() && !always_; }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    if (always_) all.emplace_back("always");
    for (const int output : chosen_)
      all.push_back(path_.facts.outputs[static_cast<std::size_t>(output)].name);
    return all;
  }
  void set(const RobotMove& move) {
    if (move.output == switched_) gate_ = move.value > 0;
    if (move.output == analogue_) level_ = std::max(0.0, move.value);
  }
  bool on() const {
    return always_ || ((switched_ < 0 || gate_) && (analogue_ < 0 || level_ > 0) && !chosen_.empty());
  }
  /// [m^3] on `length` [m] in `duration` [s].
  double volume(double length, double duration) const {
    if (!on()) return 0;
    if (!options_.flow_per_unit) return *options_.bead_area * length;
    return *options_.flow_per_unit * (analogue_ < 0 ? 1 : level_) * duration;
  }
  bool always() const { return always_; }
  bool by_time() const { return options_.flow_per_unit.has_value(); }
  double filament(double volume) const { return volume / strand_area(options_.filament_diameter); }

 private:
  void choose(bool guess) {
    const auto& outputs = path_.facts.outputs;
    for (const std::string& wanted : options_.outputs) {
      always_ = always_ || upper(wanted) == kAlways;
      if (upper(wanted) == kAlways) continue;
      const auto found = std::find_if(outputs.begin(), outputs.end(), [&](const RobotOutput& output) {
        return output_key(output.name) == output_key(wanted);
      });
      if (found == outputs.end())
        fail(outputs.empty() ? fmt::format("the program sets no output '{}', nor any other", wanted)
                             : fmt::format("the program sets no output '{}', but {}", wanted, listed()));
      chosen_.push_back(static_cast<int>(found - outputs.begin()));
    }
    const auto count = [&](bool analogue) {
      return std::count_if(chosen_.begin(), chosen_.end(),
                           [&](int i) { return outputs[static_cast<std::size_t>(i)].analogue == analogue; });
    };
    if (count(true) > 1 || count(false) > 1)
      fail("--signal takes one switched output, one analogue output, or one of each");
    if (!options_.outputs.empty() || outputs.empty()) return;
    for (std::size_t i = 0; i < outputs.size(); ++i) chosen_.push_back(static_cast<int>(i));
    if (count(true) <= 1 && count(false) <= 1) return;
    if (!guess)
      fail(fmt::format("the program sets {}: say by --signal which of them feeds filament", listed()));
    const auto most = std::max_element(outputs.begin(), outputs.end(),
                                       [](const auto& a, const auto& b) { return a.set < b.set; });
    chosen_ = {static_cast<int>(most - outputs.begin())};
  }

  std::string listed() const {
    std::vector<std::string> all;
    for (const RobotOutput& output : path_.facts.outputs) {
      if (all.size() == 10) {
        all.emplace_back("more");
        break;
      }
      all.push_back(fmt::format("{} ({} time{})", output.name, output.set, output.set == 1 ? "" : "s"));
    }
    return fmt::format("{}", fmt::join(all, ", "));
  }
  [[noreturn]] void fail(const std::string& message) const { throw InputError(Place{path_.file()}, message); }

  const RobotPath& path_;
  const ExtruderSignal& options_;
  std::vector<int> chosen_;
  int switched_ = -1, analogue_ = -1;
  bool always_ = false, gate_ = false;
  double level_ = 0;
};

class Resolver {
 public:
  Resolver(const RobotPath& path, const RobotOptions& options)
      : path_(path), options_(options), extruder_(path, options) {
    facts_ = path.facts;
    facts_.signal = extruder_.names();
  }

  Program run() {
    find_base_and_axis();
    program_.file = path_.file();
    program_.steps.reserve(path_.moves().size());
    tip_W_ = options_.X_WT_home.translation();
    X_WT_ = options_.X_WT_home;
    for (const RobotMove& move : path_.moves()) step(move);
    if (std::none_of(program_.steps.begin(), program_.steps.end(), moves))
      throw InputError(Place{path_.file()}, "0 moves, at least 1 is needed");
    if (options_.facts != nullptr) *options_.facts = facts_;
    return std::move(program_);
  }

 private:
  [[noreturn]] void fail(const RobotMove& move, const std::string& message) const {
    throw InputError(Place{path_.file(), move.line}, message);
  }

  /// The first base that prints, and the axis of the tool that points down there on average; where nothing
  /// prints, of all moves.
  void find_base_and_axis() {
    Extruder extruder = extruder_;
    Mat3 printed = Mat3::Zero(), all = Mat3::Zero();
    int first_printed = -1, first = -1;
    for (const RobotMove& move : path_.moves()) {
      if (move.kind == Kind::output) extruder.set(move);
      if (!is_move(move)) continue;
      if (first < 0) first = move.base;
      all += move.X_UN.linear();
      if (!extruder.on() || move.kind == Kind::free) continue;
      if (first_printed < 0) first_printed = move.base;
      printed += move.X_UN.linear();
    }
    base_ = first_printed >= 0 ? first_printed : first;
    if (base_ >= 0) find_axis(first_printed >= 0 ? printed : all);
  }

  void find_axis(const Mat3& sum) {
    const std::string& word = options_.tool_points;
    int axis = word.empty() ? 0 : word.back() - 'x';
    bool negative = word.starts_with('-');
    if (word.empty()) {
      const Vec3 heights = sum.row(2).transpose();  // of x, y and z of N, seen from U
      heights.cwiseAbs().maxCoeff(&axis);
      negative = heights[axis] > 0;
      const double length = sum.col(axis).norm();
      if (options_.unknown == nullptr && !(std::abs(heights[axis]) >= kClearlyDown * length && length > 0))
        throw InputError(
            Place{path_.file()},
            "which axis of the program's tool points out of its nozzle cannot be told: none points "
            "down where it prints; say so by --tool-points, one of x -x y -y z -z");
    }
    const char letter = static_cast<char>('x' + axis);
    facts_.tool_points = negative ? std::string{'-', letter} : std::string{letter};
    // z of T points the other way; y stays, or x where that is y.
    const Vec3 z = (negative ? 1 : -1) * Vec3::Unit(axis);
    Mat3 R_NT;
    R_NT.col(2) = z;
    if (axis == 1)
      R_NT.col(0) = Vec3::UnitX(), R_NT.col(1) = z.cross(Vec3::UnitX());
    else
      R_NT.col(1) = Vec3::UnitY(), R_NT.col(0) = Vec3::UnitY().cross(z);
    R_NT_ = R_NT;
  }

  Pose tool_at(const RobotMove& move) const {
    Pose X_WN = move.X_UN;
    if (move.base != base_) {
      const RobotBase& of = path_.bases()[static_cast<std::size_t>(move.base)];
      const RobotBase& part = path_.bases()[static_cast<std::size_t>(base_)];
      if (!of.X || !part.X)
        fail(move,
             fmt::format("base '{}' is used beside '{}', but where they stand the program does not say: "
                         "state both, or take the data of the controller into the file",
                         of.name, part.name));
      X_WN = part.X->inverse() * *of.X * move.X_UN;
    }
    return make_pose(Mat3(X_WN.linear() * R_NT_), Vec3(X_WN.translation() + options_.offset_W));
  }

  void step(const RobotMove& move) {
    switch (move.kind) {
      case Kind::output:
        return extruder_.set(move);
      case Kind::wait:
        return wait(move);
      case Kind::end:
        return;
      case Kind::axes:
        X_WT_ = options_.X_WT_home;
        break;
      default:
        X_WT_ = tool_at(move);
    }
    if (move.kind != Kind::straight && extruder_.on() && !extruder_.always())
      fail(move,
           "a PTP, MoveJ or axis move while the extruder is on: its path and speed are the robot's own; "
           "make it straight, or switch off before it");
    Step next = made(move, move.kind == Kind::axes       ? StepKind::home
                           : move.kind == Kind::straight ? StepKind::move
                                                         : StepKind::travel);
    if (move.kind == Kind::free && move.feed > 0) next.kind = StepKind::move;
    const double length = (X_WT_.translation() - tip_W_).norm();
    tip_W_ = X_WT_.translation();
    next.feed = move.feed;
    next.duration = move.duration;
    if (move.kind == Kind::straight)
      next.filament = extruder_.filament(
          extruder_.volume(length, move.duration > 0 ? move.duration : length / move.feed));
    if (next.filament > 0) next.kind = StepKind::print;
    program_.steps.push_back(next);
  }

  void wait(const RobotMove& move) {
    Step next = made(move, StepKind::dwell);
    next.duration = move.duration;
    if (extruder_.on() && !extruder_.always()) {
      if (extruder_.by_time()) {
        next.kind = StepKind::print;
        next.filament = extruder_.filament(extruder_.volume(0, move.duration));
      } else {
        facts_.rest_with_signal += move.duration;
      }
    }
    program_.steps.push_back(next);
  }

  Step made(const RobotMove& move, StepKind kind) const {
    Step step;
    step.kind = kind;
    step.X_WT = X_WT_;
    step.line = move.line;
    return step;
  }

  const RobotPath& path_;
  const RobotOptions& options_;
  Extruder extruder_;
  RobotFacts facts_;
  int base_ = -1;
  Mat3 R_NT_ = Mat3::Identity();
  Pose X_WT_ = Pose::Identity();
  Vec3 tip_W_ = Vec3::Zero();
  Program program_;
};

}  // namespace

Program resolve(const RobotPath& path, const RobotOptions& options) { return Resolver(path, options).run(); }

}  // namespace understudy::toolpath
