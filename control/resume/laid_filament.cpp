#include "control/resume/laid_filament.h"

#include <algorithm>
#include <deque>
#include <set>

#include "control/approach.h"
#include "machine/record/record_reader.h"

namespace understudy::control {

using machine::AxisState;
using machine::Setpoint;

namespace {

constexpr double kFed = 1e-12;  // [m], filament that is more than rounding

class Follower {
 public:
  Follower(const toolpath::Program& program, CutRecord& cut) : cut_(cut) {
    for (std::size_t i = 0; i < program.steps.size(); ++i)
      if (lays_bead(program, i)) bead_lines_.insert(program.steps[i].line);
  }

  void submit(const machine::RecordedSubmit& submit) {
    if (submit.answer == machine::Status::ok)
      queued_.insert(queued_.end(), submit.setpoints.begin(), submit.setpoints.end());
  }

  void state(const AxisState& state) {
    while (executed_ < state.executed && !queued_.empty()) execute();
    if (!queued_.empty()) feed(between(state), queued_.front().line);
    if (capacity_ == 0) capacity_ = state.free_slots + (state.accepted - state.executed);
    // A stop or a fault drops what was queued first.
    const std::size_t left = capacity_ - state.free_slots;
    for (; queued_.size() > left; queued_.pop_front()) dropped_ = true;
  }

  void finish() {
    cut_.laid.fed_at_rest = filament_;
    if (!queued_.empty()) cut_.laid.queued = queued_.back().time - last_.time;
  }

 private:
  void execute() {
    last_ = queued_.front();
    queued_.pop_front();
    ++executed_;
    if (feed(last_.filament, last_.line)) {
      cut_.laid.fed_at_setpoint = last_.filament;
      cut_.laid.axes = last_.position;
    } else if (last_.line != cut_.laid.line && !dropped_) {
      cut_.laid.ended = cut_.laid.any;
    }
  }

  /// Filament where the axes are on their way to the next setpoint, which is at most a few milliseconds off.
  double between(const AxisState& state) const {
    const Setpoint& next = queued_.front();
    if (executed_ == 0) return filament_;
    double along = 0, length = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(cut_.axes); ++i) {
      const double way = next.position[i] - last_.position[i];
      along += way * (state.position[i] - last_.position[i]);
      length += way * way;
    }
    if (length == 0) return last_.filament;
    return last_.filament + std::clamp(along / length, 0.0, 1.0) * (next.filament - last_.filament);
  }

  bool feed(double filament, int line) {
    const bool bead = filament > std::max(filament_, cut_.laid.fed) + kFed && bead_lines_.contains(line);
    filament_ = filament;
    if (!bead) return false;
    cut_.laid.any = true;
    cut_.laid.ended = false;
    cut_.laid.line = line;
    cut_.laid.fed = filament;
    return true;
  }

  CutRecord& cut_;
  std::set<int> bead_lines_;
  std::deque<Setpoint> queued_;
  Setpoint last_;
  std::uint64_t executed_ = 0;
  std::size_t capacity_ = 0;
  bool dropped_ = false;  // what follows is no part of the program
  double filament_ = 0;   // [m], now
};

}  // namespace

bool lays_bead(const toolpath::Program& program, std::size_t index) {
  const toolpath::Step& step = program.steps[index];
  return step.kind == toolpath::StepKind::print && step.filament > 0 &&
         (step.X_WT.translation() - pose_before(program, index, Pose::Identity()).translation()).norm() > 0;
}

std::string CutRecord::note(const std::string& key) const {
  for (const std::string& text : notes)
    if (text == key || text.starts_with(key + " ")) return text.substr(std::min(text.size(), key.size() + 1));
  return "";
}

CutRecord read_cut_record(const std::filesystem::path& path, const toolpath::Program& program) {
  CutRecord cut;
  cut.axes = machine::read_record(path, [&](const machine::RecordedEntry& entry) {
               if (const auto* note = std::get_if<machine::RecordedNote>(&entry))
                 cut.notes.push_back(note->text);
             }).axes;
  Follower follower(program, cut);
  machine::read_record(path, [&](const machine::RecordedEntry& entry) {
    if (const auto* submit = std::get_if<machine::RecordedSubmit>(&entry)) follower.submit(*submit);
    if (const auto* state = std::get_if<AxisState>(&entry)) follower.state(*state);
  });
  follower.finish();
  return cut;
}

}  // namespace understudy::control
