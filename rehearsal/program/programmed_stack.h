// The part as a program means it: laid on the part as drawn, or on a flat table, without errors.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "geometry/mesh.h"
#include "machine/description.h"
#include "sim/deposition/workpiece.h"
#include "toolpath/program.h"

namespace understudy::rehearsal {

constexpr double kMostLayer = 2e-3;  ///< [m]: what is farther below is no layer but air

/// The part as it grows, in beads as long as the program's steps.
class ProgrammedStack {
 public:
  /// The part may be null.
  ProgrammedStack(const machine::MachineDescription& machine,
                  const std::shared_ptr<const geometry::Mesh>& part);

  /// [m], along the tool axis down to what was laid before, or to part or table; infinity: nothing is there.
  double gap(const Vec3& tip_W, const Mat3& R) const;

  /// The tip moves on by so much path [m]: what was laid before is less fresh.
  void move(double path);
  /// A bead [m^2 of cross-section] whose nozzle runs at `gap` [m] over what is below.
  void add(const Vec3& from_W, const Vec3& to_W, const Vec3& axis_W, double gap, double area, int line);

 private:
  sim::Workpiece workpiece_;
  double flat_, widest_;              // [m]
  double path_ = 0, last_width_ = 0;  // [m]
  std::deque<double> ends_;           // path at the end of each bead that is still under the nozzle
  std::size_t fresh_from_ = 0;
};

/// One step of the program that prints.
struct ProgrammedLine {
  Vec3 from_W, to_W;  ///< [m]
  Mat3 R;             ///< of the tool
  double length = 0;  ///< [m]
  double area = 0;    ///< [m^2]
  int line = 0;       ///< of the file
};

/// Lays the lines of a program. `each` is called for every line with the stack as it is before that line, and
/// answers over which gap [m] it is laid; infinity: as a strand in the air. `areas` as programmed_areas().
void lay_program(const toolpath::Program& program, const machine::MachineDescription& machine,
                 const std::shared_ptr<const geometry::Mesh>& part, const std::vector<float>& areas,
                 const std::function<double(const ProgrammedLine&, const ProgrammedStack&)>& each);

}  // namespace understudy::rehearsal
