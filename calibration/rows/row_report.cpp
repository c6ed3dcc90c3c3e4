#include "calibration/rows/row_report.h"

#include <cmath>

namespace understudy::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr const char* kPartNames[kNoiseParts] = {"position", "turn", "distance", "point", "plane"};

}  // namespace

std::vector<PartReport> part_reports(const RowProblem& problem, const Eigen::VectorXd& before,
                                     const Eigen::VectorXd& after, const AddedNoise& added) {
  const auto parts = parts_of(problem);
  const auto scattered = scatter(problem, after, Eigen::VectorXd::Zero(after.size()), added);
  std::vector<PartReport> reports;
  for (std::size_t part = 0; part < kNoiseParts; ++part) {
    if (scattered[part].equations == 0) continue;
    PartReport report;
    report.name = kPartNames[part];
    report.equations = scattered[part].equations;
    const bool single = part == static_cast<std::size_t>(NoisePart::distance) ||
                        part == static_cast<std::size_t>(NoisePart::plane);
    report.values = single ? report.equations : report.equations / 3;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (static_cast<std::size_t>(parts[i]) != part) continue;
      report.before += std::pow(before[static_cast<Index>(i)], 2);
      report.after += std::pow(after[static_cast<Index>(i)], 2);
    }
    report.before = std::sqrt(report.before / report.values);
    report.after = std::sqrt(report.after / report.values);
    report.added = added[part];
    report.told = scattered[part].all_told;
    reports.push_back(report);
  }
  return reports;
}

std::vector<FoundNumber> found_numbers(const SurroundingsLayout& layout, const Surroundings& around,
                                       const MatrixXd& covariance) {
  std::vector<FoundNumber> numbers;
  for (const std::string& name : layout.names) numbers.push_back({name, 0, 0, false});
  const auto set = [&](Index column, const Vec3& values, bool angle) {
    for (Index k = 0; column >= 0 && k < 3; ++k) {
      numbers[static_cast<std::size_t>(column + k)].value = values[k];
      numbers[static_cast<std::size_t>(column + k)].angle = angle;
    }
  };
  const auto poses = [&](const auto& slots, const std::vector<Pose>& at) {
    for (std::size_t i = 0; i < slots.size(); ++i) {
      set(slots[i].position, at[i].translation(), false);
      set(slots[i].turn, log_rotation(at[i].linear()), true);
    }
  };
  poses(layout.frames, around.frames);
  poses(layout.targets, around.targets);
  for (std::size_t i = 0; i < layout.points.size(); ++i)
    set(layout.points[i].position, around.points[i], false);
  for (std::size_t i = 0; i < layout.anchors.size(); ++i) {
    set(layout.anchors[i].position, around.anchors[i], false);
    if (layout.anchors[i].turn >= 0)
      numbers[static_cast<std::size_t>(layout.anchors[i].turn)].value = around.zeros[i];
  }
  for (std::size_t i = 0; i < layout.planes.size(); ++i) {
    const Index column = layout.planes[i].position;
    set(column, {0, 0, around.planes[i].offset}, false);
    numbers[static_cast<std::size_t>(column)].angle = numbers[static_cast<std::size_t>(column + 1)].angle =
        true;
  }
  const Index first = covariance.rows() - layout.columns();
  for (std::size_t k = 0; k < numbers.size(); ++k)
    numbers[k].sigma = std::sqrt(covariance(first + static_cast<Index>(k), first + static_cast<Index>(k)));
  return numbers;
}

}  // namespace understudy::calibration
