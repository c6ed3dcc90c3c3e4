// How long the gap loop computes on this computer, and how evenly: the print loop with continuous gap control
// on the quasistatic twin of a machine that was built within its tolerances and then calibrated, by the time
// that passes outside its calls of the port.
//   gap_loop_bench [PROGRAM] [SEED]     default scenarios/song-bottle.gcode 6
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/guarded.h"
#include "control/print.h"
#include "control/program/gcode_options.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "geometry/mesh.h"
#include "machine/fixture_file.h"
#include "sim/sensors/microscope.h"
#include "sim/twin/simulated_port.h"
#include "studies/gap/lab_machine.h"
#include "toolpath/gcode/gcode.h"
#include "vision/plain_instructions.h"

namespace understudy {
namespace {

using Clock = std::chrono::steady_clock;
using machine::Status;

constexpr double kCycle = 1e-3;    // [s], between setpoints
constexpr double kMargin = 15e-3;  // [s] of motion that is queued when a frame has come

/// A port of which every call stops the watch: what it counts is the controller's time.
class TimedPort : public machine::MachinePort {
 private:
  template <typename Call>
  auto stopped(Call call) const {
    counted_ += std::chrono::duration<double>(Clock::now() - running_since_).count();
    auto answer = call();
    running_since_ = Clock::now();
    return answer;
  }

 public:
  explicit TimedPort(machine::MachinePort& port) : port_(port) {
    cycles.reserve(1 << 20);
    frames.reserve(1 << 16);
    ages.reserve(1 << 16);
  }
  int axis_count() const override { return port_.axis_count(); }
  double now() const override {
    return stopped([&] { return port_.now(); });
  }
  machine::AxisState state() const override {
    return stopped([&] { return port_.state(); });
  }
  Status submit(std::span<const machine::Setpoint> setpoints, double deadline) override {
    const Status answer = stopped([&] { return port_.submit(setpoints, deadline); });
    if (answer != Status::ok) return answer;
    fed_ = true;
    if (exposed_at_ > 0) {
      frames.push_back(counted_ - frame_came_);
      ages.push_back(port_.now() - exposed_at_);
    }
    exposed_at_ = 0;
    return answer;
  }
  Status wait_until(double time) override {
    end_of_cycle();
    return stopped([&] { return port_.wait_until(time); });
  }
  Status urgent(machine::UrgentCommand command) override {
    return stopped([&] { return port_.urgent(command); });
  }
  Status set_outputs(const machine::Outputs& outputs, double deadline) override {
    return stopped([&] { return port_.set_outputs(outputs, deadline); });
  }
  Status capture(const Region& region, machine::Frame& frame, double deadline) override {
    end_of_cycle();
    const Status answer = stopped([&] { return port_.capture(region, frame, deadline); });
    frame_came_ = counted_;
    exposed_at_ = answer == Status::ok ? frame.exposed_at : 0;
    return answer;
  }

  std::vector<double> cycles;  ///< [s], of the controller, from one wait or frame to the next, where it fed
  std::vector<double> frames;  ///< [s], of the controller, from a frame to the setpoints that follow
  std::vector<double> ages;    ///< [s], of the port's clock, from the middle of the exposure to these

 private:
  void end_of_cycle() {
    static_cast<void>(stopped([] { return 0; }));
    if (fed_) cycles.push_back(counted_ - cycle_began_);
    fed_ = false;
    cycle_began_ = counted_;
  }

  machine::MachinePort& port_;
  mutable Clock::time_point running_since_ = Clock::now();
  mutable double counted_ = 0;  // [s]
  double cycle_began_ = 0, frame_came_ = 0, exposed_at_ = 0;
  bool fed_ = false;
};

double share(const std::vector<double>& sorted, double part) {
  return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
}

/// In decades of three steps. False: the figure that is named is above the limit.
bool print_histogram(const char* what, std::vector<double> seconds, double limit) {
  if (seconds.empty()) throw MachineError(std::string(what) + ": none was timed");
  std::sort(seconds.begin(), seconds.end());
  std::printf("%s: %zu\n", what, seconds.size());
  double from = 0;
  for (const double to :
       {10e-6, 20e-6, 50e-6, 100e-6, 200e-6, 500e-6, 1e-3, 2e-3, 5e-3, 10e-3, 20e-3, 50e-3, 1.0}) {
    const auto count = std::lower_bound(seconds.begin(), seconds.end(), to) -
                       std::lower_bound(seconds.begin(), seconds.end(), from);
    if (count > 0)
      std::printf("  to %8.2f ms  %8td  %6.2f %%\n", 1e3 * to, count,
                  100.0 * static_cast<double>(count) / static_cast<double>(seconds.size()));
    from = to;
  }
  const double median = share(seconds, 0.5), late = share(seconds, 0.999);
  const bool met = late <= limit;
  std::printf(
      "  median %.3f ms, 99 %% %.3f ms, 99.9 %% %.3f ms, at most %.3f ms; jitter (99.9 %% less the median) "
      "%.3f ms\n",
      1e3 * median, 1e3 * share(seconds, 0.99), 1e3 * late, 1e3 * seconds.back(), 1e3 * (late - median));
  std::printf("  99.9 %% within %.0f ms: %s\n", 1e3 * limit, met ? "met" : "MISSED");
  return met;
}

int run(const std::string& file, std::uint64_t seed) {
  vision::hold_opencv_to_plain_instructions();  // as the command does
  const studies::LabMachine lab = studies::make_lab_machine(machine::load_machine("hexapod"), seed);
  const auto program = toolpath::parse_gcode(read_file(file), file, control::gcode_options({}, lab.machine));
  const std::shared_ptr<const geometry::Mesh> part = geometry::read_stl(machine::find_fixture("bottle"));
  const auto plant = sim::make_quasistatic_plant(lab.truth, lab.built);
  sim::Microscope microscope(lab.truth, part, seed);
  sim::SimulatedPort twin(lab.machine, *plant, [&](const sim::Shot& shot) { return microscope.expose(shot); },
                          {});
  TimedPort port(twin);
  control::PrintOptions options;
  options.gap_control = control::GapControl::continuous;
  options.part = part.get();
  const control::PrintResult result = control::print(program, lab.machine, port, options);
  if (!result.completed) throw MachineError("the print stopped: " + result.stop.why);
  std::printf("%s: %.1f s of print\n", file.c_str(), result.duration);
  // Of the port's clock alone: exposure and transfer, and what the loop waits for.
  const bool ages = print_histogram("exposure to setpoints, on the machine's clock", port.ages, 0.1);
  const bool frames = print_histogram("frame to setpoints, of this computer", port.frames, kMargin);
  const bool cycles = print_histogram("a control cycle, of this computer", port.cycles, kCycle);
  return ages && frames && cycles ? 0 : 1;
}

}  // namespace
}  // namespace understudy

int main(int argc, char** argv) {
  return understudy::bench::guarded("gap_loop_bench", [&] {
    const std::string file = argc > 1 ? argv[1] : "scenarios/song-bottle.gcode";
    return understudy::run(file, argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 6);
  });
}
