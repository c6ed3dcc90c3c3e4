#include "toolpath/robot/robot_path.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "toolpath/robot/robot_frames.h"

namespace understudy::toolpath {
namespace {

constexpr double kArcTolerance = 2e-6;    // [m], as of G-code
constexpr double kLongestWait = 86400;    // [s]
constexpr double kFastest = 100;          // [m/s]
constexpr double kSlowest = 1e-9;         // [m/s]
constexpr double kMostValue = 1e9;        // of an output
constexpr std::size_t kMostOutputs = 64;  // a program that sets more feeds nothing by them
constexpr std::size_t kMostBases = 10'000;

}  // namespace

void RobotPath::fail(const std::string& message) const { throw InputError(Place{file_, line_}, message); }

void RobotPath::set_base(const RobotBase& base) {
  const auto same = [&](const RobotBase& known) {
    return known.name == base.name && known.X.has_value() == base.X.has_value() &&
           (!base.X || known.X->matrix() == base.X->matrix());
  };
  if (base_ >= 0 && same(bases_[static_cast<std::size_t>(base_)])) return;
  const auto known = std::find_if(bases_.begin(), bases_.end(), same);
  const int next = static_cast<int>(known - bases_.begin());
  if (known == bases_.end()) {
    if (base.X) require_place(*base.X, fmt::format(" of base '{}'", base.name));
    if (bases_.size() == kMostBases) fail(fmt::format("more than {} bases", kMostBases));
    bases_.push_back(base);
  }
  // The tool stays where it is.
  if (X_UN_ && base_ >= 0 && base.X && bases_[static_cast<std::size_t>(base_)].X)
    X_UN_ = base.X->inverse() * *bases_[static_cast<std::size_t>(base_)].X * *X_UN_;
  else if (base_ >= 0)
    X_UN_.reset();
  base_ = next;
}

RobotMove& RobotPath::add(RobotMove::Kind kind) {
  if (base_ < 0) set_base({"", Pose::Identity()});
  RobotMove move;
  move.kind = kind;
  move.base = base_;
  move.line = line_;
  if (X_UN_) move.X_UN = *X_UN_;
  moves_.push_back(move);
  return moves_.back();
}

void RobotPath::count_move(double feed) {
  ++facts.bases[bases_[static_cast<std::size_t>(base_)].name];
  ++facts.tools[tool_];
  if (feed <= 0) return;
  facts.slowest = facts.slowest > 0 ? std::min(facts.slowest, feed) : feed;
  facts.fastest = std::max(facts.fastest, feed);
}

void RobotPath::finish_move() {
  moves_.insert(moves_.end(), after_next_.begin(), after_next_.end());
  after_next_.clear();
}

void RobotPath::require_place(const Pose& X, const std::string& whose) const {
  const double farthest = X.translation().cwiseAbs().maxCoeff();
  if (!(farthest <= kLargestCoordinate) || !X.matrix().allFinite())
    fail(fmt::format("a coordinate{} of {:.6g} mm is beyond {:.6g} mm", whose, to_mm(farthest),
                     to_mm(kLargestCoordinate)));
}

/// One step of a straight or round move.
void RobotPath::line(const Pose& X_UN, double feed, double duration) {
  if (duration <= 0 && !(feed >= kSlowest && feed <= kFastest))
    fail(feed == 0 ? "a straight move before any speed: set it first"
                   : fmt::format("a speed of {:.6g} mm/s is outside {:.6g}..{:.6g} mm/s", to_mm(feed),
                                 to_mm(kSlowest), to_mm(kFastest)));
  if (duration > kLongestWait)
    fail(fmt::format("a move of {:.6g} s is longer than {:g} s", duration, kLongestWait));
  X_UN_ = X_UN;
  RobotMove& move = add(RobotMove::Kind::straight);
  move.feed = duration > 0 ? 0 : feed;
  move.duration = std::max(0.0, duration);
}

void RobotPath::straight(const Pose& X_UN, double feed, double duration) {
  require_place(X_UN);
  line(X_UN, feed, duration);
  count_move(duration > 0 ? 0 : feed);
  finish_move();
}

void RobotPath::free(const Pose& X_UN, double feed) {
  require_place(X_UN);
  X_UN_ = X_UN;
  add(RobotMove::Kind::free).feed = feed;
  count_move(0);
  finish_move();
}

void RobotPath::arc(const Vec3& via_U, const Pose& X_UN, std::optional<double> angle, double feed,
                    double duration) {
  require_place(X_UN);
  require_place(make_pose(Quat::Identity(), via_U));
  if (!X_UN_) fail("an arc whose start the program does not say: move to it first");
  const Pose from = *X_UN_;
  const auto chords = arc_through({from.translation(), via_U, X_UN.translation()}, angle, kArcTolerance);
  if (!chords) fail("no arc: its three points lie on a line or agree");
  if (chords->too_many())
    fail(fmt::format("an arc of {:.6g} chords, at most {}", chords->count, kMostArcChords));
  chords_ += chords->ends.size();
  if (chords_ > chords_max_)
    fail(fmt::format("the program's arcs have more than {} chords up to here", chords_max_));
  for (std::size_t i = 0; i < chords->ends.size(); ++i) {
    Pose X = interpolate(from, X_UN, static_cast<double>(i + 1) / chords->count);
    X.translation() = chords->ends[i];
    line(X, feed, duration / chords->count);
  }
  count_move(duration > 0 ? 0 : feed);
  finish_move();
}

void RobotPath::axes() {
  add(RobotMove::Kind::axes);
  X_UN_.reset();
  if (facts.axis_moves++ == 0) facts.first_axis_move = line_;
  finish_move();
}

void RobotPath::wait(double seconds) {
  if (!(seconds >= 0 && seconds <= kLongestWait))
    fail(fmt::format("a wait of {:.6g} s is outside 0..{:g} s", seconds, kLongestWait));
  if (seconds > 0) add(RobotMove::Kind::wait).duration = seconds;
}

int RobotPath::output_index(const std::string& name, bool analogue) {
  const auto known = std::find_if(facts.outputs.begin(), facts.outputs.end(),
                                  [&](const RobotOutput& output) { return output.name == name; });
  if (known != facts.outputs.end()) {
    known->analogue = known->analogue || analogue;
    return static_cast<int>(known - facts.outputs.begin());
  }
  if (facts.outputs.size() == kMostOutputs) fail(fmt::format("more than {} outputs are set", kMostOutputs));
  facts.outputs.push_back({name, analogue});
  return static_cast<int>(facts.outputs.size()) - 1;
}

void RobotPath::set_output(const std::string& name, double value, bool analogue, bool after_next) {
  if (!(std::abs(value) <= kMostValue)) fail(fmt::format("{} is set to {:.6g}", name, value));
  const int index = output_index(name, analogue);
  RobotOutput& output = facts.outputs[static_cast<std::size_t>(index)];
  output.low = output.set > 0 ? std::min(output.low, value) : value;
  output.high = output.set > 0 ? std::max(output.high, value) : value;
  ++output.set;
  RobotMove& move = add(RobotMove::Kind::output);
  move.output = index;
  move.value = value;
  if (!after_next) return;
  after_next_.push_back(move);
  moves_.pop_back();
}

void RobotPath::end() { add(RobotMove::Kind::end); }

}  // namespace understudy::toolpath
