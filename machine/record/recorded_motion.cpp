#include "machine/record/recorded_motion.h"

#include <fmt/format.h>

#include "core/error.h"

namespace understudy::machine {
namespace {

class Collector {
 public:
  explicit Collector(RecordedMotion& motion) : motion_(motion) {}

  void operator()(const RecordedNote& note) { motion_.notes.push_back(note.text); }
  void operator()(const RecordedSubmit& submit) {
    if (submit.answer == Status::ok && seen(submit.now))
      motion_.commands.push_back({submit.now, submit.setpoints});
  }
  void operator()(const RecordedUrgent& urgent) {
    if (urgent.answer == Status::ok && seen(urgent.now))
      motion_.commands.push_back({urgent.now, urgent.command});
  }
  void operator()(const AxisState& state) {
    if (!seen(state.time)) return;
    motion_.fault = state.fault;
    if (state.fault == Fault::none) add(motion_.drives, {state.sampled_at, state.position});
  }
  void operator()(const LoadReading& reading) {
    if (motion_.fault == Fault::none) add(motion_.load, reading);
  }
  void operator()(const RecordedWait& wait) { static_cast<void>(seen(wait.now)); }
  void operator()(const RecordedOutputs& outputs) { static_cast<void>(seen(outputs.now)); }
  void operator()(const RecordedFrame& frame) { static_cast<void>(seen(frame.now)); }

 private:
  /// Whether no fault stands; takes the record's clock along.
  bool seen(double now) {
    if (motion_.fault != Fault::none) return false;
    if (!begun_) motion_.begins = now;
    begun_ = true;
    motion_.ends = now;
    return true;
  }
  /// A reading that is no newer than the one before is that one.
  static void add(std::vector<LoadReading>& readings, const LoadReading& reading) {
    if (readings.empty() || reading.sampled_at > readings.back().sampled_at) readings.push_back(reading);
  }

  RecordedMotion& motion_;
  bool begun_ = false;
};

}  // namespace

std::string RecordedMotion::note(const std::string& key) const {
  for (const std::string& text : notes)
    if (text.starts_with(key + " ")) return text.substr(key.size() + 1);
  return {};
}

RecordedMotion read_motion(const std::filesystem::path& path) {
  RecordedMotion motion;
  motion.file = path.string();
  Collector collect(motion);
  const RecordEnd end = read_record(path, [&](const RecordedEntry& entry) { std::visit(collect, entry); });
  motion.axes = end.axes;
  motion.whole = end.whole;
  if (motion.drives.empty())
    throw InputError({motion.file},
                     end.whole ? "it holds no state of the machine: nothing has moved while it was written"
                               : "it was cut short before the first state of the machine");
  return motion;
}

void require_same_machine(const RecordedMotion& motion, const MachineDescription& machine) {
  const int axes = machine.make_mechanism()->axis_count();
  if (motion.axes != axes)
    throw InputError({motion.file},
                     fmt::format("it is of a machine of {} axes, and --machine {} has {}: name the machine "
                                 "that was recorded",
                                 motion.axes, machine.name, axes));
  const std::string recorded = motion.note("machine_sha256");
  if (!recorded.empty() && recorded != machine.sha256)
    throw InputError({motion.file},
                     fmt::format("it was recorded with another machine file, of checksum {:.12}... and not "
                                 "{:.12}... as --machine {}: name that file",
                                 recorded, machine.sha256, machine.name));
}

}  // namespace understudy::machine
