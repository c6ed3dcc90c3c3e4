#include "control/registration/register_part.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "control/approach_motion.h"
#include "control/gap/gap_reading.h"
#include "control/gap/sensor_uncertainty.h"
#include "control/standing_pose.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "core/units.h"
#include "machine/optics_mounting.h"

namespace understudy::control {

using toolpath::Step;
using toolpath::StepKind;

namespace {

constexpr double kApproachFeed = 5e-3;  // [m/s]

/// A root of the covariance of how laser and microscope are mounted; no columns where nothing is stated.
Eigen::MatrixXd mounting_root(const machine::MachineDescription& machine) {
  if (machine.gap_sensor) {
    const Eigen::SelfAdjointEigenSolver<machine::MountingMatrix> solver(machine.gap_sensor->covariance);
    return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
  }
  if (!machine.tolerances.mounting) return Eigen::MatrixXd(machine::kMountingFreedoms, 0);
  return machine::mounting_sigmas(*machine.tolerances.mounting).asDiagonal();
}

/// Each next place is the nearest one left.
std::vector<ProbingPlace> shortest_way(std::vector<ProbingPlace> places, Vec3 from) {
  for (auto next = places.begin(); next != places.end(); ++next) {
    std::iter_swap(next, std::min_element(next, places.end(), [&](const auto& a, const auto& b) {
                     return (a.p_W - from).squaredNorm() < (b.p_W - from).squaredNorm();
                   }));
    from = next->p_W;
  }
  return places;
}

class Registrar {
 public:
  Registrar(const RegistrationTask& task, const machine::MachineDescription& machine,
            machine::MachinePort& port)
      : task_(task),
        machine_(machine),
        port_(port),
        check_(machine, *task.part, largest_shift(*task.part, task.tolerance)),
        cycle_(machine, port, standing_pose(machine, port)),
        started_at_(port.now()) {
    approach_.kind = StepKind::move;
    approach_.feed = kApproachFeed;
  }

  Registration run() {
    measure_all();
    if (!result_.stop) result_.stop = go_home();
    if (!result_.stop) fit();
    result_.duration = port_.now() - started_at_;
    return std::move(result_);
  }

 private:
  void measure_all();
  void measure(const ProbingPlace& place);
  void read_place(PlaceReading& reading);
  void fit();
  Stop go_home();
  Stop rise();
  Stop travel(const Pose& X_WT);

  const RegistrationTask& task_;
  const machine::MachineDescription& machine_;
  machine::MachinePort& port_;
  const ProbingCheck check_;
  ControlCycle cycle_;
  const double started_at_;
  Step approach_;
  Registration result_;
};

void Registrar::measure_all() {
  const std::size_t wanted =
      std::min(task_.places.size(), static_cast<std::size_t>(std::max(0, task_.wanted)));
  const auto spare = task_.places.begin() + static_cast<std::ptrdiff_t>(wanted);
  for (const ProbingPlace& place :
       shortest_way({task_.places.begin(), spare}, cycle_.resting_pose().translation()))
    if (!result_.stop) measure(place);
  for (auto next = spare; next != task_.places.end() && !result_.stop; ++next)
    if (result_.measured() < static_cast<int>(wanted)) measure(*next);
}

Stop Registrar::travel(const Pose& X_WT) {
  Step step;
  step.kind = StepKind::travel;
  step.X_WT = X_WT;
  if (Stop stop = cycle_.push(step)) return stop;
  return cycle_.come_to_rest();
}

/// Straight up, from where nothing is beside the tool.
Stop Registrar::rise() {
  Pose up = cycle_.resting_pose();
  if (up.translation().z() >= check_.clear_height()) return {};
  up.translation().z() = check_.clear_height();
  return travel(up);
}

void Registrar::measure(const ProbingPlace& place) {
  stop_if_interrupted();
  PlaceReading reading;
  reading.place = place;
  const ProbingWay way = check_.way_to(place);
  try {
    Stop stop = rise();
    for (const Pose& X_WT : {way.above, way.near, way.start})
      if (!stop) stop = travel(X_WT);
    if (!stop) {
      read_place(reading);
      stop = port_.state().fault == machine::Fault::none ? travel(way.near)
                                                         : stop_of(machine::Status::faulted, port_);
    }
    result_.stop = std::move(stop);
  } catch (const InputError& error) {
    // Between two poses that can be reached lies one that cannot: the tool rests on the way.
    static_cast<void>(cycle_.come_to_rest());
    reading.why = error.what();
  }
  result_.places.push_back(std::move(reading));
}

void Registrar::read_place(PlaceReading& reading) {
  const Pose X_WT = reading.place.X_WT(0);
  ApproachMotion motion(cycle_, approach_);
  const LocalSurface surface = local_surface(*task_.part, X_WT);
  reading.outcome = close_gap(machine_, surface, X_WT, check_.standoff(), motion,
                              task_.gap.value_or(gap_controller_options(machine_)));
  const GapOutcome& outcome = reading.outcome;
  if (outcome.stop != GapStop::none) {
    reading.why = fmt::format("{}: {}", to_string(outcome.stop), outcome.why);
    return;
  }
  reading.X_WT_end = X_WT;
  reading.X_WT_end.translation() += outcome.offset_W;
  Vec3 dot_T;
  if (!dot_place(machine_, surface, outcome.gap, dot_T)) {
    reading.why = "the beam misses the part";
    return;
  }
  const Vec3 slope_normal(-surface.slope.x(), -surface.slope.y(), 1);
  const double normal_share = 1 / slope_normal.norm();  // of a change of the gap, along the normal
  reading.point.p_W = reading.X_WT_end * dot_T;
  reading.reading_sigma = outcome.sigma * normal_share;
  reading.point.sigma = std::hypot(reading.reading_sigma, task_.place_sigma);
  reading.point.common = common_errors(machine_, surface, outcome.gap, normal_share);
  reading.measured = true;
}

Stop Registrar::go_home() {
  try {
    if (Stop stop = rise()) return stop;
    Pose home = machine_.X_WB * machine_.X_BT_home, above = home;
    above.translation().z() = std::max(home.translation().z(), cycle_.resting_pose().translation().z());
    if (Stop stop = travel(above)) return stop;
    return travel(home);
  } catch (const InputError& error) {
    static_cast<void>(cycle_.come_to_rest());
    Stop stop;
    stop.status = machine::Status::rejected;
    stop.why = error.what();
    return stop;
  }
}

void Registrar::fit() {
  std::vector<MeasuredPoint> points;
  for (const PlaceReading& reading : result_.places)
    if (reading.measured) points.push_back(reading.point);
  if (static_cast<int>(points.size()) < kPlacesMin) {
    result_.refused = fmt::format("only {} of {} places could be measured, at least {} are needed",
                                  points.size(), result_.places.size(), kPlacesMin);
    for (const PlaceReading& reading : result_.places)
      if (!reading.measured) {
        result_.refused += "; the first that failed: " + reading.why;
        break;
      }
    return;
  }
  result_.fit = fit_part(*task_.part, points, task_.tolerance);
  const PartFit& found = *result_.fit;
  auto residual = found.residuals.begin();
  double worst = 0;
  for (PlaceReading& reading : result_.places)
    if (reading.measured) {
      reading.residual = *residual++;
      worst = std::max(worst, std::abs(reading.residual));
    }
  if (!found.converged)
    result_.refused = "no pose of the drawn part explains the readings: the fit does not converge";
  else if (!found.expected_part())
    result_.refused = fmt::format(
        "the readings do not fit the drawn part: chi-square {:.1f} for {} degrees of freedom, at most {:.1f} "
        "is "
        "plausible; the worst place is {:.3f} mm off it",
        found.chi_square, found.degrees_of_freedom, found.chi_square_limit, to_mm(worst));
}

}  // namespace

int Registration::measured() const {
  return static_cast<int>(
      std::count_if(places.begin(), places.end(), [](const auto& p) { return p.measured; }));
}

Eigen::VectorXd common_errors(const machine::MachineDescription& machine, const LocalSurface& surface,
                              double gap, double normal_share) {
  const Eigen::MatrixXd root = mounting_root(machine);
  machine::MountingVector derivatives;
  if (!reading_derivatives(machine, surface, gap, derivatives)) derivatives.setZero();
  return normal_share * root.transpose() * derivatives;
}

Registration register_part(const RegistrationTask& task, const machine::MachineDescription& machine,
                           machine::MachinePort& port) {
  return Registrar(task, machine, port).run();
}

}  // namespace understudy::control
