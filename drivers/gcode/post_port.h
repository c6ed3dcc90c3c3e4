// A port that writes what it is told as a program for a controller without a driver.
#pragma once

#include <functional>
#include <string>

#include "drivers/gcode/block_fitter.h"
#include "drivers/gcode/gcode_words.h"
#include "drivers/gcode/path_sampler.h"
#include "machine/description.h"
#include "machine/port.h"

namespace understudy::drivers {

/// How many blocks a controller has to take, and how fast.
struct PostFigures {
  std::size_t blocks = 0, bytes = 0;
  double duration = 0;               ///< [s], of motion
  std::size_t blocks_in_second = 0;  ///< the most in any second of motion
  std::size_t bytes_in_second = 0;
};

/// The controller that a program is written for.
struct PostController {
  GcodeFamily family = GcodeFamily::marlin;
  GcodeAxes axes;
  FitTolerance tolerance;
  bool has_outputs = true;  ///< false: heater and fan are not its business
};

/// The machine rests at `start`. Its clock runs as fast as it is asked to. There is no camera; outputs become
/// lines, or none where the controller has none.
class PostPort : public machine::MachinePort {
 public:
  PostPort(const machine::MachineDescription& machine, const PostController& controller,
           const machine::AxisVector& start, std::function<void(const std::string&)> line);

  /// Lines that put the controller in order and take it to the start; before anything else.
  void begin();

  int axis_count() const override { return writer_.axes().count(); }
  double now() const override { return now_; }
  machine::AxisState state() const override;
  machine::Status submit(std::span<const machine::Setpoint> setpoints, double deadline) override;
  machine::Status wait_until(double time) override;
  machine::Status urgent(machine::UrgentCommand command) override;
  machine::Status set_outputs(const machine::Outputs& outputs, double deadline) override;
  machine::Status capture(const Region& region, machine::Frame& frame, double deadline) override;

  const PostFigures& figures() const { return figures_; }

 private:
  void write_blocks();
  void write(const std::string& line);

  GcodeWriter writer_;
  PathSampler path_;
  BlockFitter fitter_;
  bool has_outputs_;
  std::function<void(const std::string&)> line_;
  machine::Outputs outputs_;
  PostFigures figures_;
  double second_began_ = 0;  ///< [s], of motion
  std::size_t blocks_then_ = 0, bytes_then_ = 0;
  double now_ = 0;
  machine::Fault fault_ = machine::Fault::none;
};

}  // namespace understudy::drivers
