#include "calibration/identifiability.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "calibration/strut_model.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

constexpr int kMaxColumns = 9;      // of one strut: 7, dev and play
constexpr double kRounding = 1e-7;  // of the largest singular value, whose square loses half the digits
constexpr double kAboveNoise = 2;   // times the RMS that noise alone makes: the largest of three such is 1.7
constexpr double kSameReading = 1e-6;  // [m]

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, Eigen::Dynamic, kMaxColumns>;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxColumns, 1>;

/// One strut's rows over all poses and, by column, the variance that noise of the poses gives an entry.
struct StrutRows {
  Rows rows;
  Columns noise;
};

void fill(const Unknowns& unknowns, const std::vector<StrutLinearisation>& all, const Problem& problem,
          std::size_t strut, StrutRows& out) {
  const auto i = static_cast<Eigen::Index>(strut);
  const auto count = static_cast<Eigen::Index>(all.size());
  const Eigen::Index columns = kStrutParameters + (unknowns.deviation ? 1 : 0) + (unknowns.play ? 1 : 0);
  const HexapodGeometry& g = problem.nominal.geometry;
  const double arm2 = g.platform_joint[strut].squaredNorm();
  out.rows.resize(count, columns);
  out.noise = Columns::Zero(columns);
  double of_b = 0, of_a = 0;
  for (Eigen::Index j = 0; j < count; ++j) {
    const StrutLinearisation& at = all[static_cast<std::size_t>(j)];
    const PoseSample& sample = problem.samples[static_cast<std::size_t>(j)];
    out.rows.row(j).head<kStrutParameters>() = at.by_geometry.col(i).transpose();
    Eigen::Index column = kStrutParameters;
    if (unknowns.deviation) out.rows(j, column++) = at.by_deviation[i];
    if (unknowns.play) out.rows(j, column++) = at.by_play[i];
    // The strut's direction turns with the error of its ball joint; a_i's column turns with the platform too.
    const double length2 = (g.base_joint[strut] - sample.X_BT * g.platform_joint[strut]).squaredNorm();
    const double position = sample.covariance.topLeftCorner<3, 3>().trace() / 3;
    const double turn = sample.covariance.bottomRightCorner<3, 3>().trace() / 3;
    of_b += (position + arm2 * turn) / length2;
    of_a += turn + position / length2;
  }
  out.noise.head<3>().setConstant(of_b / static_cast<double>(count));
  out.noise.segment<3>(3).setConstant(of_a / static_cast<double>(count));
  out.rows /= std::sqrt(static_cast<double>(count));
}

struct Rank {
  int rank = 0;
  double condition = 0;
};

/// Singular values by the eigenvalues of rows^T rows: several times quicker than of the rows themselves, and
/// all that count are above the noise, far above the rounding of squares.
Rank rank_of(const Rows& rows, const Columns& noise) {
  using Gram = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxColumns, kMaxColumns>;
  const Eigen::SelfAdjointEigenSolver<Gram> eigen(Gram(rows.transpose() * rows));
  const auto value = [&eigen](Eigen::Index k) { return std::sqrt(std::max(0.0, eigen.eigenvalues()[k])); };
  const double largest = value(rows.cols() - 1);
  Rank result;
  for (Eigen::Index k = 0; k < rows.cols(); ++k) {
    const double by_noise = std::sqrt(eigen.eigenvectors().col(k).cwiseAbs2().dot(noise));
    if (value(k) > std::max(kRounding * largest, kAboveNoise * by_noise)) ++result.rank;
  }
  const bool resolved = value(0) > kRounding * largest;
  result.condition = resolved ? largest / value(0) : kinematics::kSingularCondition;
  return result;
}

bool same_stand(const PoseSample& a, const PoseSample& b, const Unknowns& unknowns) {
  for (std::size_t i = 0; i < kStruts; ++i) {
    if (std::abs(a.displacement[i] - b.displacement[i]) > kSameReading) return false;
    if (unknowns.play && a.approach[i] != b.approach[i]) return false;
  }
  return true;
}

/// Poses that differ from all before them. Measurements of the same stand that contradict each other warn.
std::size_t distinct_poses(const Problem& problem, const Unknowns& unknowns,
                           std::vector<std::string>& warnings) {
  std::vector<std::size_t> distinct;
  for (std::size_t j = 0; j < problem.samples.size(); ++j) {
    const PoseSample& sample = problem.samples[j];
    const auto twin = std::find_if(distinct.begin(), distinct.end(), [&](std::size_t k) {
      return same_stand(sample, problem.samples[k], unknowns);
    });
    if (twin == distinct.end()) {
      distinct.push_back(j);
      continue;
    }
    const PoseSample& first = problem.samples[*twin];
    const Vec3 apart = sample.X_BT.translation() - first.X_BT.translation();
    const double noise = std::sqrt((sample.covariance + first.covariance).topLeftCorner<3, 3>().trace());
    if (apart.norm() < 4 * noise || sample.approach != first.approach) continue;
    warnings.push_back(fmt::format(
        "poses {} and {} were commanded alike but measured {:.3f} mm apart, {:.0f} times their noise",
        *twin + 1, j + 1, to_mm(apart.norm()), apart.norm() / noise));
  }
  return distinct.size();
}

std::string too_few(std::size_t have, std::size_t distinct, int unknowns) {
  const int needed = (unknowns + kStruts - 1) / kStruts;
  const std::string repeated =
      have == distinct ? "" : " (" + std::to_string(have) + " rows, of which some repeat others)";
  return std::to_string(distinct) + " different poses" + repeated + " give " + std::to_string(6 * distinct) +
         " equations for " + std::to_string(unknowns) + " unknowns: measure at least " +
         std::to_string(needed) + ", better 12 or more";
}

std::string one_sided_play(const Problem& problem) {
  for (std::size_t i = 0; i < kStruts; ++i) {
    bool shortening = false, lengthening = false;
    for (const PoseSample& sample : problem.samples) {
      shortening = shortening || sample.approach[i] == Approach::shortening;
      lengthening = lengthening || sample.approach[i] == Approach::lengthening;
    }
    if (!shortening || !lengthening)
      return "strut " + std::to_string(i + 1) + " never came to a pose by " +
             (shortening    ? "lengthening"
              : lengthening ? "shortening"
                            : "a known direction") +
             ": its play cannot be told from its length offset; measure poses approached from both sides";
  }
  return {};
}

void find_ranks(const Problem& problem, const Unknowns& unknowns, Identifiability& found) {
  std::vector<StrutLinearisation> all(problem.samples.size());
  const HexapodParameters start = search_start(problem, unknowns);
  for (std::size_t j = 0; j < all.size(); ++j)
    linearise(start, problem.samples[j], problem.samples[j].X_BT, all[j]);
  StrutRows strut;
  bool deviation_seen = false;
  for (std::size_t i = 0; i < kStruts; ++i) {
    fill(unknowns, all, problem, i, strut);
    const Rank rank = rank_of(strut.rows, strut.noise);
    found.strut_unknowns = static_cast<int>(strut.rows.cols());
    found.strut_rank[i] = rank.rank;
    found.condition = std::max(found.condition, rank.condition);
    deviation_seen = deviation_seen || rank.rank == found.strut_unknowns;
    found.rank += std::min(rank.rank, found.strut_unknowns - (unknowns.deviation ? 1 : 0));
  }
  if (unknowns.deviation && deviation_seen) ++found.rank;
}

}  // namespace

HexapodParameters search_start(const Problem& problem, const Unknowns& unknowns) {
  HexapodParameters start = problem.nominal;
  if (unknowns.deviation) start.geometry.deviation = std::max(1e-3, start.geometry.deviation);
  return start;
}

Identifiability check_identifiability(const Problem& problem, const Unknowns& unknowns) {
  Identifiability found;
  const auto stop = [&found](Status status, std::string message) {
    found.status = status;
    found.message = std::move(message);
    return found;
  };
  if (const Fault fault = input_fault(problem); !fault.message.empty()) {
    found.pose = fault.pose;
    return stop(Status::bad_input, fault.message);
  }
  const std::size_t have = problem.samples.size();
  const std::size_t distinct = distinct_poses(problem, unknowns, found.warnings);
  const auto needed = static_cast<std::size_t>((unknowns.count() + kStruts - 1) / kStruts);
  if (distinct < needed)
    return stop(have < needed ? Status::too_few_poses : Status::repeated_poses,
                too_few(have, distinct, unknowns.count()));
  if (std::string dead = dead_measurement(problem); !dead.empty())
    return stop(Status::dead_measurement, dead);
  find_ranks(problem, unknowns, found);
  if (std::string still = missing_rotation(problem); !still.empty()) return stop(Status::no_rotation, still);
  if (unknowns.play)
    if (std::string sided = one_sided_play(problem); !sided.empty())
      return stop(Status::rank_deficient, sided);
  if (found.rank == unknowns.count()) return found;
  const auto worst = std::min_element(found.strut_rank.begin(), found.strut_rank.end());
  return stop(Status::rank_deficient,
              "these poses tell " + std::to_string(found.rank) + " of " + std::to_string(unknowns.count()) +
                  " unknowns apart beyond their noise (strut " +
                  std::to_string(worst - found.strut_rank.begin() + 1) + ": " + std::to_string(*worst) +
                  " of " + std::to_string(found.strut_unknowns) +
                  "): add poses with more tilt, in more directions, and farther apart");
}

}  // namespace understudy::calibration
