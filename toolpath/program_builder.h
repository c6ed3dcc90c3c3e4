// Appends the steps of a print program, so that every planner writes them alike.
#pragma once

#include "toolpath/program.h"

namespace understudy::toolpath {

class ProgramBuilder {
 public:
  explicit ProgramBuilder(double filament_diameter);

  /// Heater [K] (0 leaves it alone) and fan [0..1], before the first motion, which goes to `first`.
  void begin(const Pose& first, double temperature, double fan);
  void travel(const Pose& X_WT);
  /// Without filament, at `feed` [m/s].
  void move(const Pose& X_WT, double feed);
  /// Lays `volume` [m^3] on the path to X_WT.
  void print(const Pose& X_WT, double feed, double volume);
  void dwell(double seconds);

  const Pose& tool() const { return X_WT_; }  ///< where the tool is by now
  bool empty() const { return program_.steps.empty(); }
  Program take() { return std::move(program_); }

 private:
  Step& add(StepKind kind, const Pose& X_WT);

  double filament_area_;
  Pose X_WT_ = Pose::Identity();
  Program program_;
};

/// A tool that stands `height` [m] off `p` along the unit vector `axis`, without spin of its own.
Pose tool_at(const Vec3& p, const Vec3& axis, double height = 0);

}  // namespace understudy::toolpath
