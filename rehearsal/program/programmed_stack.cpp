#include "rehearsal/program/programmed_stack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/printed_clearance.h"
#include "sim/deposition/bead_section.h"

namespace understudy::rehearsal {
namespace {

std::array<float, 3> floats(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace

ProgrammedStack::ProgrammedStack(const machine::MachineDescription& machine,
                                 const std::shared_ptr<const geometry::Mesh>& part)
    : workpiece_(part),
      flat_(machine.tool.flat_diameter),
      widest_(sim::kWidestLine * machine.tool.nozzle_diameter) {}

double ProgrammedStack::gap(const Vec3& tip_W, const Mat3& R) const {
  const auto below = workpiece_.below(make_pose(R, tip_W), fresh_from_);
  return below ? below->distance : std::numeric_limits<double>::infinity();
}

void ProgrammedStack::move(double path) {
  path_ += path;
  while (!ends_.empty() && ends_.front() < path_ - geometry::fresh_path(flat_, last_width_)) {
    ends_.pop_front();
    ++fresh_from_;
  }
}

void ProgrammedStack::add(const Vec3& from_W, const Vec3& to_W, const Vec3& axis_W, double gap, double area,
                          int line) {
  const double strand = std::min(widest_, std::sqrt(4 * area / std::numbers::pi));
  const bool lies = gap > 0 && gap < kMostLayer;
  last_width_ = lies ? std::min(widest_, sim::bead_width(area, gap)) : strand;
  sim::Bead bead;
  bead.height = static_cast<float>(lies ? std::min(gap, last_width_) : strand);
  bead.width = std::max(bead.height, static_cast<float>(last_width_));
  const Vec3 down = 0.5 * static_cast<double>(bead.height) * axis_W;
  bead.from_W = floats(from_W - down);
  bead.to_W = floats(to_W - down);
  bead.up_W = floats(axis_W);
  bead.line = line;
  workpiece_.add(bead);
  ends_.push_back(path_);
}

void lay_program(const toolpath::Program& program, const machine::MachineDescription& machine,
                 const std::shared_ptr<const geometry::Mesh>& part, const std::vector<float>& areas,
                 const std::function<double(const ProgrammedLine&, const ProgrammedStack&)>& each) {
  ProgrammedStack stack(machine, part);
  ProgrammedLine laid;
  Vec3 tip = (machine.X_WB * machine.X_BT_home).translation();
  for (const toolpath::Step& step : program.steps) {
    if (!toolpath::moves(step)) continue;
    laid.from_W = tip;
    laid.to_W = tip = step.X_WT.translation();
    laid.R = step.X_WT.linear();
    laid.length = (laid.to_W - laid.from_W).norm();
    laid.line = step.line;
    stack.move(laid.length);
    laid.area = static_cast<double>(areas[static_cast<std::size_t>(std::max(0, step.line))]);
    if (step.filament <= 0 || laid.area <= 0 || laid.length == 0) continue;
    const double gap = each(laid, stack);
    stack.add(laid.from_W, laid.to_W, laid.R.col(2), gap, laid.area, step.line);
  }
}

}  // namespace understudy::rehearsal
