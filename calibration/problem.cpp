#include "calibration/problem.h"

#include <cmath>

namespace understudy::calibration {

const char* to_string(Status status) {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::bad_input:
      return "bad input";
    case Status::too_few_poses:
      return "too few poses";
    case Status::repeated_poses:
      return "repeated poses";
    case Status::dead_measurement:
      return "dead measurement";
    case Status::no_rotation:
      return "no rotation";
    case Status::rank_deficient:
      return "rank deficient";
    case Status::not_converged:
      return "not converged";
    case Status::unsupported:
      return "unsupported";
    case Status::no_answer:
      return "no answer";
  }
  return "unknown";
}

Fault fault_of_pose(std::size_t j, const std::string& what) {
  return {"pose " + std::to_string(j + 1) + ": " + what, j};
}

StrutLengths displacements(const HexapodGeometry& nominal, const StrutLengths& lengths) {
  StrutLengths displacement;
  for (std::size_t i = 0; i < kStruts; ++i) displacement[i] = lengths[i] - nominal.length_offset[i];
  return displacement;
}

StrutLengths strut_lengths(const HexapodParameters& machine, const PoseSample& sample) {
  StrutLengths lengths;
  for (std::size_t i = 0; i < kStruts; ++i)
    lengths[i] = machine.geometry.length_offset[i] + sample.displacement[i] -
                 0.5 * machine.play[i] * static_cast<double>(sample.approach[i]);
  return lengths;
}

HexapodParameters moved(const HexapodParameters& from, const ParameterVector& by, const Unknowns& unknowns) {
  HexapodParameters to = from;
  for (std::size_t i = 0; i < kStruts; ++i) {
    const auto first = kStrutParameters * static_cast<Eigen::Index>(i);
    to.geometry.base_joint[i] += by.segment<3>(first);
    to.geometry.platform_joint[i] += by.segment<3>(first + 3);
    to.geometry.length_offset[i] += by[first + 6];
    if (unknowns.play) to.play[i] += by[unknowns.first_play() + static_cast<Eigen::Index>(i)];
  }
  // Only its square is in the model.
  if (unknowns.deviation) to.geometry.deviation = std::abs(from.geometry.deviation + by[kGeometryParameters]);
  return to;
}

}  // namespace understudy::calibration
