// What was asked of a port, and whether HAL's sampler received it: every period once and in order.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "machine/setpoint_queue.h"
#include "tests/drivers/hal/hal_machine.h"

namespace understudy::drivers {

/// Passes everything on and remembers it.
class RememberingPort : public machine::MachinePort {
 public:
  struct Call {
    double now = 0;  ///< [s], the port's clock
    enum Kind { submit, hold, resume, stop } kind = submit;
    std::vector<machine::Setpoint> setpoints;
  };

  explicit RememberingPort(machine::MachinePort& port) : port_(port), start_(port.state().position) {}

  int axis_count() const override { return port_.axis_count(); }
  double now() const override { return port_.now(); }
  machine::AxisState state() const override { return port_.state(); }
  machine::Status submit(std::span<const machine::Setpoint> setpoints, double deadline) override {
    const double now = port_.now();
    const machine::Status s = port_.submit(setpoints, deadline);
    if (s == machine::Status::ok) calls_.push_back({now, Call::submit, {setpoints.begin(), setpoints.end()}});
    return s;
  }
  machine::Status wait_until(double time) override { return port_.wait_until(time); }
  machine::Status urgent(machine::UrgentCommand command) override {
    using machine::UrgentCommand;
    const auto kind = command == UrgentCommand::hold     ? Call::hold
                      : command == UrgentCommand::resume ? Call::resume
                                                         : Call::stop;
    if (command != UrgentCommand::clear_fault) calls_.push_back({port_.now(), kind, {}});
    return port_.urgent(command);
  }
  machine::Status set_outputs(const machine::Outputs& outputs, double deadline) override {
    return port_.set_outputs(outputs, deadline);
  }
  machine::Status capture(const Region& region, machine::Frame& frame, double deadline) override {
    return port_.capture(region, frame, deadline);
  }

  /// Where the axes are to be, a row a servo period, by the project's queue alone: what was asked, asked
  /// again at the same times of the port's clock, whose grain is half a period.
  std::vector<machine::AxisVector> rows(double cycle) const {
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    machine::SetpointQueueOptions options;
    options.ranges.assign(static_cast<std::size_t>(port_.axis_count()), {-kEndless, kEndless});
    options.rest_velocity.fill(1e-6);
    machine::SetpointQueue queue(options, start_, 0);
    std::vector<machine::AxisVector> rows;
    const double tick = cycle / 2;
    std::int64_t ticks = 0;
    const auto run_until = [&](double time) {
      while (static_cast<double>(ticks) * tick < time - tick / 2) {
        const double now = static_cast<double>(++ticks) * tick;
        queue.advance_to(now);
        queue.pass(tick, now);
        if (ticks % 2 == 0) rows.push_back(queue.target().position);
      }
    };
    for (const Call& call : calls_) {
      run_until(call.now);
      if (call.kind == Call::submit) {
        EXPECT_EQ(queue.submit(call.setpoints, call.now), machine::Status::ok);
      }
      if (call.kind == Call::hold) queue.hold();
      if (call.kind == Call::resume) queue.resume();
      if (call.kind == Call::stop) queue.stop(call.now);
    }
    run_until(port_.now());
    return rows;
  }

 private:
  machine::MachinePort& port_;
  machine::AxisVector start_;
  std::vector<Call> calls_;
};

/// Samples of channel 1 against the rows that were asked for. A row may come again where the axes rest (a
/// pause); none is lost, none comes twice in motion, none is out of order. Returns how many were matched.
inline std::size_t expect_received(const std::vector<std::vector<double>>& samples,
                                   const std::vector<machine::AxisVector>& rows,
                                   const HalSettings& settings) {
  const std::size_t n = settings.machine_axes, number = settings.axes.size();
  // halsampler prints six decimals of mm; the rows have nine.
  const auto same = [&](const std::vector<double>& sample, const machine::AxisVector& row) {
    for (std::size_t i = 0; i < n; ++i)
      if (std::abs(sample[i] - settings.axes[i].units(row[i])) > 0.51e-6) return false;
    return true;
  };
  std::size_t matched = 0;
  double last_number = 0;
  for (const std::vector<double>& sample : samples) {
    if (sample.size() != number + 2) {
      ADD_FAILURE() << "a sample of " << sample.size() << " columns";
      return matched;
    }
    if (sample[number] == 0 || sample[number] == last_number) continue;  // before the first row; no new row
    if (last_number != 0) {
      EXPECT_EQ(sample[number], last_number + 1) << "a row is lost or out of order";
    }
    last_number = sample[number];
    if (matched < rows.size() && same(sample, rows[matched])) {
      ++matched;
      continue;
    }
    const machine::AxisVector& before = rows[matched > 0 ? matched - 1 : 0];
    const bool rests = matched == 0 || matched >= rows.size() || same(sample, before);
    if (!rests) {
      ADD_FAILURE() << std::setprecision(12) << "row " << last_number << " is not setpoint " << matched
                    << " of " << rows.size() << ": " << sample[0] << " mm, not "
                    << settings.axes[0].units(rows[matched][0]) << " after "
                    << settings.axes[0].units(before[0]);
      return matched;
    }
    if (matched > 1 && matched < rows.size()) {
      // A pause: by what was asked for, the axes rested before it or rest after it. Where a hold ends as it
      // comes to rest, the row beside it is a braking's first or last: 30 mm/s in 0.1 s, half a (1 ms)^2.
      constexpr double kRowFromRest = 0.5 * (30e-3 * 1.1 / machine::kBrakingTime) * 1e-6;  // [m]
      double before_it = 0, after_it = 0;
      for (std::size_t i = 0; i < n; ++i) {
        before_it = std::max(before_it, std::abs(rows[matched - 1][i] - rows[matched - 2][i]));
        after_it = std::max(after_it, std::abs(rows[matched][i] - rows[matched - 1][i]));
      }
      EXPECT_LT(std::min(before_it, after_it), kRowFromRest)
          << "setpoint " << matched << " was repeated in motion";
    }
  }
  return matched;
}

}  // namespace understudy::drivers
