#include "rehearsal/replayed_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "machine/built_tolerances.h"
#include "machine/load_encoders.h"
#include "machine/record/commanded_path.h"
#include "rehearsal/preparation.h"
#include "rehearsal/run_twin.h"
#include "sim/plant/plant.h"
#include "sim/twin/simulated_port.h"

namespace understudy::rehearsal {
namespace {

using kinematics::AxisVector;
using machine::LoadReading;
using machine::RecordedMotion;
using machine::Status;

constexpr double kSigmas = 3;                 // of the play from joint to joint
constexpr std::size_t kBetweenReports = 512;  // samples

double all_play(const machine::MachineDescription& machine, int axis) {
  return machine.visit(
      [](const machine::HexapodModel& hexapod) { return hexapod.play.screw_nut + hexapod.play.ball_joint; },
      [&](const machine::ChainModel& chain) { return chain.play[static_cast<std::size_t>(axis)]; });
}

/// The twin beside the record, from its beginning to its end.
class Replayer {
 public:
  Replayer(const RecordedMotion& motion, const TwinSetup& setup, ReplayedRecord& result)
      : motion_(motion),
        plant_(make_plant(setup)),
        port_(setup.machine, *plant_, {}, {}, options_of(setup)),
        commanded_(motion, setup.machine),
        result_(result) {}

  void run(const Progress& progress);

 private:
  static sim::TwinOptions options_of(const TwinSetup& setup) {
    sim::TwinOptions options;
    options.queue_capacity = std::size_t{1} << 17U;  // what the recorded port took finds room
    options.load_encoders.emplace(setup.truth, setup.as_built,
                                  machine::load_encoder_counts(setup.machine.file.string()));
    return options;
  }
  double twin_time(double recorded) const { return recorded - motion_.begins; }
  bool give(const machine::RecordedCommand& command);
  bool run_to(double recorded);
  void compare(const LoadReading& measured, bool load);
  bool refuse(double recorded, Status answer);

  const RecordedMotion& motion_;
  std::unique_ptr<sim::Plant> plant_;
  sim::SimulatedPort port_;
  machine::CommandedPath commanded_;
  ReplayedRecord& result_;
};

bool Replayer::refuse(double recorded, Status answer) {
  if (!port_.engine_failure().empty()) throw MachineError(port_.engine_failure());
  const machine::Fault fault = port_.state().fault;
  result_.stopped =
      fmt::format("the twin answers {}{} at {:.3f} s, line {}, where the machine went on", to_string(answer),
                  fault == machine::Fault::none ? "" : fmt::format(" ({})", to_string(fault)),
                  twin_time(recorded), commanded_.at(recorded).line);
  return false;
}

bool Replayer::run_to(double recorded) {
  const Status answer = port_.wait_until(twin_time(recorded));
  return answer == Status::ok || refuse(recorded, answer);
}

bool Replayer::give(const machine::RecordedCommand& command) {
  if (!run_to(command.now)) return false;
  Status answer{};
  if (const auto* recorded = std::get_if<std::vector<machine::Setpoint>>(&command.what)) {
    std::vector<machine::Setpoint> setpoints = *recorded;
    for (machine::Setpoint& s : setpoints) s.time = twin_time(s.time);
    answer = port_.submit(setpoints, port_.now());
  } else {
    answer = port_.urgent(std::get<machine::UrgentCommand>(command.what));
  }
  return answer == Status::ok || refuse(command.now, answer);
}

/// The twin stands at a step of its clock: its axes are taken along to the time of the measurement.
void Replayer::compare(const LoadReading& measured, bool load) {
  const auto& target = commanded_.at(measured.sampled_at);
  ReplayedRow row{twin_time(measured.sampled_at), target.line, measured.position, port_.state().position};
  if (load) {
    LoadReading reading;
    if (!port_.read_load(reading)) return;
    row.twin = reading.position;
  }
  const double ahead = row.time - port_.now();
  for (std::size_t i = 0; i < row.twin.size(); ++i) row.twin[i] += ahead * target.velocity[i];
  (load ? result_.load_rows : result_.drive_rows).push_back(row);
}

void Replayer::run(const Progress& progress) {
  std::size_t command = 0, drive = 0, load = 0, samples = 0;
  const auto due = [](const auto& list, std::size_t next, auto time) {
    return next < list.size() ? time(list[next]) : std::numeric_limits<double>::infinity();
  };
  const auto sampled = [](const LoadReading& reading) { return reading.sampled_at; };
  while (true) {
    const double at_command = due(motion_.commands, command, [](const auto& c) { return c.now; });
    const double at_drive = due(motion_.drives, drive, sampled), at_load = due(motion_.load, load, sampled);
    const double next = std::min(at_drive, at_load);
    if (std::min(next, at_command) == std::numeric_limits<double>::infinity()) return;
    if (at_command < next) {
      if (!give(motion_.commands[command++])) return;
      continue;
    }
    if (!run_to(next)) return;
    compare(at_load < at_drive ? motion_.load[load++] : motion_.drives[drive++], at_load < at_drive);
    if (++samples % kBetweenReports != 0) continue;
    stop_if_interrupted();
    if (progress)
      progress((next - motion_.begins) / std::max(1e-9, motion_.ends - motion_.begins), "replaying");
  }
}

AxisDifference difference_of(const std::vector<ReplayedRow>& rows, std::size_t axis) {
  AxisDifference difference;
  double sum = 0, squares = 0;
  for (const ReplayedRow& row : rows) {
    const double d = row.machine[axis] - row.twin[axis];
    sum += d;
    squares += d * d;
    if (std::abs(d) <= std::abs(difference.largest)) continue;
    difference.largest = d;
    difference.time = row.time;
    difference.line = row.line;
  }
  const double count = static_cast<double>(std::max<std::size_t>(1, rows.size()));
  difference.mean = sum / count;
  difference.rms = std::sqrt(squares / count);
  return difference;
}

void summarise(const RecordReplayRequest& request, const machine::MachineDescription& machine,
               ReplayedRecord& result) {
  for (const MeasuredSide side : {MeasuredSide::drive, MeasuredSide::load}) {
    const auto& rows = side == MeasuredSide::load ? result.load_rows : result.drive_rows;
    for (std::size_t i = 0; !rows.empty() && i < result.axis_names.size(); ++i) {
      AxisDifference difference = difference_of(rows, i);
      difference.axis = result.axis_names[i];
      difference.angle = result.axis_angles[i];
      difference.side = side;
      difference.agreed = (difference.angle ? request.agree_angle : request.agree_length)
                              .value_or(agreed_default(machine, static_cast<int>(i), side));
      result.differences.push_back(difference);
    }
  }
}

void tell_limits(const RecordedMotion& motion, const ReplayedRecord& result,
                 std::vector<std::string>& notes) {
  if (!motion.whole) notes.emplace_back("the record was cut short: compared up to its last whole entry");
  if (motion.fault != machine::Fault::none)
    notes.emplace_back(fmt::format("the machine has the fault '{}' at {:.3f} s: compared up to there",
                                   to_string(motion.fault), motion.ends - motion.begins));
  if (motion.load.empty())
    notes.emplace_back(
        "the record has no encoders behind the play: play, zero offsets and leads of the machine cannot "
        "show");
  else if (result.load_rows.empty())
    notes.emplace_back(
        "the machine file has no load_encoders: what the record measured behind the play is not compared");
}

}  // namespace

const char* to_string(MeasuredSide side) { return side == MeasuredSide::drive ? "drive" : "load"; }

double agreed_default(const machine::MachineDescription& machine, int axis, MeasuredSide side) {
  const machine::Drive& drive = machine.drives[static_cast<std::size_t>(axis)];
  if (side == MeasuredSide::drive) return drive.lead / drive.steps_per_turn + drive.step();
  const std::string file = machine.file.string();
  const double share = 1 + kSigmas * machine::load_built_tolerances(file).play;
  const bool turns = machine.make_mechanism()->axis_is_angle(axis);
  return share * all_play(machine, axis) + drive.step() + machine::load_encoder_counts(file).of(turns);
}

bool AxisDifference::agrees() const { return std::abs(largest) <= agreed; }

bool ReplayedRecord::agrees() const {
  return stopped.empty() && std::all_of(differences.begin(), differences.end(),
                                        [](const AxisDifference& d) { return d.agrees(); });
}

ReplayedRecord replay_record(const RecordReplayRequest& request, const Progress& progress) {
  if (progress) progress(0, "reading");
  const RecordedMotion motion = machine::read_motion(request.record);
  Mended mended;
  RehearsalRequest twin;
  twin.machine = request.twin.machine;
  twin.as_built = request.twin.as_built;
  twin.engine = request.twin.engine;
  twin.seed = request.twin.seed;
  const TwinSetup setup = prepare(twin, mended);
  machine::require_same_machine(motion, setup.machine);
  ReplayedRecord result;
  result.record = request.record;
  result.machine = setup.machine.name;
  result.as_built = setup.as_built.source;
  result.engine = setup.engine;
  result.command = request.twin.command;
  result.whole = motion.whole;
  const auto mechanism = setup.machine.make_mechanism();
  for (int i = 0; i < mechanism->axis_count(); ++i) {
    result.axis_names.push_back(mechanism->axis_name(i));
    result.axis_angles.push_back(mechanism->axis_is_angle(i));
  }
  Replayer(motion, setup, result).run(progress);
  summarise(request, setup.machine, result);
  tell_limits(motion, result, result.notes);
  return result;
}

}  // namespace understudy::rehearsal
