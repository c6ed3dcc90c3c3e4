// Random operations on a port and on a simple model of docs/machine-port.md: they agree after each. The model
// lets time pass until the port has braked or sped up again; what a command does on the way is the business
// of port_conformance.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <ostream>
#include <vector>

#include <rapidcheck/state.h>

#include "tests/machine/port_conformance.h"
#include "tests/property.h"

namespace understudy::machine {

/// What the queue promises, without positions.
struct PortModel {
  static constexpr double kSpacing = 4e-3;  // [s], between setpoints at least
  static constexpr double kSettled = 0.2;   // [s], twice as long as braking takes

  struct Queued {
    double time = 0;  ///< [s]
    bool moving = false;
  };

  std::size_t capacity = 0;
  double clock_step = 0;  ///< [s], of the port: by so much a change of speed may be off
  double now = 0;         ///< [s]
  double lag = 0;         ///< [s], of the queue's clock
  double blur = 0;        ///< [s], of the lag
  double last_time = 0;   ///< [s], that the next setpoint must be after
  bool held = false, faulted = false;
  std::vector<Queued> queue;
  std::size_t accepted = 0, executed = 0;

  /// No setpoint is so near to the queue's clock `ahead` from now that nobody can say whether it is executed.
  bool decided(double ahead) const {
    const double clock = now - lag + ahead, unsure = blur + 2 * clock_step;
    return std::none_of(queue.begin(), queue.end(),
                        [&](const Queued& q) { return std::abs(q.time - clock) <= unsure; });
  }

  /// The queue's clock goes on by `run` while the port's goes on by `pass`.
  void advance(double run, double pass) {
    if (faulted) return;
    const double clock = now - lag + run;
    std::size_t done = 0;
    while (done < queue.size() && queue[done].time <= clock) ++done;
    executed += done;
    const bool dry = done > 0 && done == queue.size() && queue.back().moving;
    lag += pass - run;
    now = dry ? queue.back().time + lag : now + pass;
    queue.erase(queue.begin(), queue.begin() + static_cast<std::ptrdiff_t>(done));
    if (dry) {
      faulted = true;
      rest();
    }
  }
  /// Nothing is queued and the axes rest.
  void rest() {
    queue.clear();
    lag = blur = 0;
    held = false;
    last_time = now;
  }
};

using PortCommand = rc::state::Command<PortModel, PortOnTrial>;

namespace port_commands {

constexpr double kLong = 1e9;  // [s], a deadline that never comes

inline void compare(const PortModel& model, PortOnTrial& trial) {
  const AxisState s = trial.port().state();
  RC_ASSERT(s.accepted == model.accepted);
  RC_ASSERT(s.executed == model.executed);
  RC_ASSERT(s.free_slots == model.capacity - model.queue.size());
  RC_ASSERT(s.moving == (!model.queue.empty() && !model.held));
  RC_ASSERT((s.fault != Fault::none) == model.faulted);
  RC_ASSERT(std::abs(s.time - model.now) <= model.blur + 3 * model.clock_step);
}

struct Submit : PortCommand {
  int count;
  double first = *property::real(PortModel::kSpacing, 0.05);  ///< [s], after what is queued or now
  double spacing = *property::real(PortModel::kSpacing, 0.02);
  bool rests_at_end = *property::whole(0, 9) < 9;

  Submit() : Submit(*property::whole(1, 20)) {}
  explicit Submit(int how_many) : count(how_many) {}

  std::vector<Setpoint> setpoints(const PortModel& model, const AxisVector& start) const {
    std::vector<Setpoint> made;
    const double begin = std::max(model.last_time, model.now) + first;
    for (int i = 0; i < count; ++i) {
      Setpoint s;
      s.time = begin + spacing * i;
      s.position = start;
      s.position[0] += 1e-4 * (i % 7);
      if (i + 1 < count || !rests_at_end) s.velocity[0] = 0.01;
      made.push_back(s);
    }
    return made;
  }
  Status expected(const PortModel& model) const {
    const auto size = static_cast<std::size_t>(count);
    if (model.faulted) return Status::faulted;
    if (size > model.capacity) return Status::rejected;
    return size > model.capacity - model.queue.size() ? Status::queue_full : Status::ok;
  }
  void apply(PortModel& model) const override {
    if (expected(model) != Status::ok) return;
    if (model.queue.empty() && !model.held) model.lag = model.blur = 0;
    for (const Setpoint& s : setpoints(model, {})) {
      model.queue.push_back({s.time, s.velocity[0] != 0});
      model.last_time = s.time;
    }
    model.accepted += static_cast<std::size_t>(count);
  }
  void run(const PortModel& model, PortOnTrial& trial) const override {
    AxisVector start = trial.port().state().position;
    start[0] = 0.5 * (trial.range.lower + trial.range.upper);
    RC_ASSERT(trial.port().submit(setpoints(model, start), kLong) == expected(model));
    compare(nextState(model), trial);
  }
  void show(std::ostream& out) const override {
    out << "submit " << count << " after " << first << " s, one every " << spacing << " s"
        << (rests_at_end ? "" : ", moving at the end");
  }
};

/// As many as fill the queue, or one more than it has room for, or one more than it can hold.
struct SubmitMany : Submit {
  explicit SubmitMany(const PortModel& model)
      : Submit(static_cast<int>(*rc::gen::element(model.capacity - model.queue.size(),
                                                  model.capacity - model.queue.size() + 1,
                                                  model.capacity + 1))) {
    spacing = PortModel::kSpacing;
    rests_at_end = true;
  }
  void checkPreconditions(const PortModel& /*model*/) const override { RC_PRE(count > 0); }
};

/// One of the last two setpoints cannot be meant: nothing of the call is taken.
struct SubmitWrong : PortCommand {
  int wrong = *property::whole(0, 4);
  bool last = *rc::gen::arbitrary<bool>();

  void run(const PortModel& model, PortOnTrial& trial) const override {
    std::vector<Setpoint> two(2);
    for (Setpoint& s : two) s.position = trial.port().state().position;
    two[0].time = std::max(model.last_time, model.now) + 1;
    two[1].time = two[0].time + 1;
    Setpoint& bad = two[last ? 1 : 0];
    if (wrong == 0) bad.time = std::nan("");
    if (wrong == 1) bad.time = model.now - model.lag - 1;
    if (wrong == 2) bad.velocity[0] = std::numeric_limits<double>::infinity();
    if (wrong == 3) bad.position[0] = trial.range.upper + 1e-6;
    if (wrong == 4) bad.filament = std::nan("");
    const bool room = model.queue.size() + 2 <= model.capacity;
    const Status expected = model.faulted ? Status::faulted : room ? Status::rejected : Status::queue_full;
    RC_ASSERT(trial.port().submit(two, kLong) == expected);
    compare(model, trial);
  }
  void show(std::ostream& out) const override { out << "submit two, " << last << " is wrong by " << wrong; }
};

struct Wait : PortCommand {
  double seconds = *property::real(0, 0.3);

  void checkPreconditions(const PortModel& model) const override {
    RC_PRE(model.held || model.decided(seconds));
  }
  void apply(PortModel& model) const override { model.advance(model.held ? 0 : seconds, seconds); }
  void run(const PortModel& model, PortOnTrial& trial) const override {
    const PortModel after = nextState(model);
    const double position = trial.port().state().position[0];
    const Status expected = after.faulted ? Status::faulted : Status::ok;
    RC_ASSERT(trial.port().wait_until(model.now + seconds) == expected);
    if (model.held || model.faulted) RC_ASSERT(trial.port().state().position[0] == position);
    compare(after, trial);
  }
  void show(std::ostream& out) const override { out << "wait " << seconds << " s"; }
};

/// Until all that is queued is executed.
struct Drain : Wait {
  explicit Drain(const PortModel& model) {
    seconds = model.queue.empty() ? 0 : model.queue.back().time - (model.now - model.lag) + 0.05;
  }
};

/// An urgent command, and time until the axes have braked or go again.
struct Urgent : PortCommand {
  UrgentCommand command = *rc::gen::element(UrgentCommand::hold, UrgentCommand::resume, UrgentCommand::stop);

  /// Of the queue's clock, until the port has settled: braking linearly, it goes half as far.
  double running(const PortModel& model) const {
    if (command == UrgentCommand::resume)
      return model.held ? PortModel::kSettled - kBrakingTime / 2 : PortModel::kSettled;
    return model.held ? 0 : kBrakingTime / 2;
  }
  void checkPreconditions(const PortModel& model) const override {
    RC_PRE(!model.faulted);
    RC_PRE(model.decided(running(model)));
    // Nobody can say when it runs dry while its clock slows down.
    const bool ends_moving = !model.queue.empty() && model.queue.back().moving;
    RC_PRE(!(ends_moving && model.queue.back().time <= model.now - model.lag + running(model)));
  }
  void apply(PortModel& model) const override {
    const bool changes =
        command == UrgentCommand::resume ? model.held : !model.held || command == UrgentCommand::stop;
    const bool at_rest = model.queue.empty();
    if (command == UrgentCommand::stop && at_rest) {
      model.rest();
      model.advance(PortModel::kSettled, PortModel::kSettled);
      model.last_time = model.now - PortModel::kSettled;
      return;
    }
    if (changes) model.blur += model.clock_step;
    model.advance(running(model), PortModel::kSettled);
    if (command == UrgentCommand::hold) model.held = true;
    if (command == UrgentCommand::resume) model.held = false;
    if (command == UrgentCommand::stop) model.rest();
  }
  void run(const PortModel& model, PortOnTrial& trial) const override {
    const double before = trial.port().now();
    RC_ASSERT(trial.port().urgent(command) == Status::ok);
    RC_ASSERT(trial.port().now() == before);
    RC_ASSERT(trial.port().wait_until(model.now + PortModel::kSettled) == Status::ok);
    compare(nextState(model), trial);
  }
  void show(std::ostream& out) const override {
    out << (command == UrgentCommand::hold ? "hold" : command == UrgentCommand::resume ? "resume" : "stop");
  }
};

struct ClearFault : PortCommand {
  void apply(PortModel& model) const override { model.faulted = false; }
  void run(const PortModel& model, PortOnTrial& trial) const override {
    RC_ASSERT(trial.port().urgent(UrgentCommand::clear_fault) == Status::ok);
    compare(nextState(model), trial);
  }
  void show(std::ostream& out) const override { out << "clear fault"; }
};

}  // namespace port_commands

inline void expect_port_obeys_the_model(MakePort make, const property::Trials& trials) {
  property::check(trials, [make] {
    using namespace port_commands;
    const std::unique_ptr<PortOnTrial> trial = make();
    PortModel model;
    model.capacity = trial->capacity;
    model.clock_step = trial->clock_step;
    model.now = model.last_time = trial->port().now();
    rc::state::check(model, *trial,
                     rc::state::gen::execOneOfWithArgs<Submit, Submit, Submit, SubmitMany, SubmitWrong, Wait,
                                                       Wait, Drain, Urgent, Urgent, ClearFault>());
  });
}

}  // namespace understudy::machine
