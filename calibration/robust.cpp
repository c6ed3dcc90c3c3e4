// Maximum likelihood after reweighted least trimmed squares over whole poses (Rousseeuw and Van Driessen
// 2006): a target taken for another, a reflection or a touched platform spoils one pose with all its numbers.
//  1. Many fits to 8 random poses; each is improved by keeping the h poses nearest to it (C-steps).
//  2. The one with the smallest trimmed sum starts; poses join while they are plausible beside the fit.
//  3. The estimate is the likelihood's maximum over the poses that joined.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "calibration/calibrated.h"
#include "calibration/estimator.h"
#include "calibration/identifiability.h"
#include "calibration/pose_error_fit.h"
#include "core/random.h"

namespace understudy::calibration {
namespace {

constexpr std::size_t kStartPoses = 8;  // one more than the unknowns need: 7 often leave a strut ill told
constexpr int kStarts = 60;           // of which 99 % hit 8 good poses when a quarter of 24 are bad: 1 in 16
constexpr std::size_t kBest = 5;      // starts that are followed to the end
constexpr int kShortFit = 6;          // iterations
constexpr double kGoodShare = 0.75;   // of the poses, at least, are taken for good
constexpr double kPlausible = 22.46;  // 0.999 quantile of chi-square with 6 degrees of freedom

struct Candidate {
  std::vector<bool> used;
  HexapodParameters machine;
  std::vector<double> distances;  ///< of every pose beside the fit, in its own covariance
  double trimmed = std::numeric_limits<double>::infinity();
};

class TrimmedSearch {
 public:
  TrimmedSearch(const Problem& problem, const Options& options)
      : problem_(problem),
        options_(options),
        objective_(problem),
        random_(options.seed, "robust calibration") {
    const std::size_t count = problem.samples.size();
    core_ =
        std::max(kStartPoses, static_cast<std::size_t>(std::ceil(kGoodShare * static_cast<double>(count))));
    core_ = std::min(core_, count);
  }

  /// The poses to use; empty where no start led to a fit.
  std::vector<bool> search() {
    std::vector<Candidate> all;
    for (int n = 0; n < kStarts; ++n) {
      Candidate candidate;
      candidate.used = draw();
      if (refit(candidate, kShortFit) && concentrate(candidate) && concentrate(candidate))
        all.push_back(std::move(candidate));
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Candidate& a, const Candidate& b) { return a.trimmed < b.trimmed; });
    Candidate best;
    for (std::size_t n = 0; n < std::min(kBest, all.size()); ++n) {
      double before = std::numeric_limits<double>::infinity();
      while (all[n].trimmed < before) {
        before = all[n].trimmed;
        if (!concentrate(all[n])) break;
      }
      if (all[n].trimmed < best.trimmed) best = all[n];
    }
    if (!best.used.empty()) admit(best);
    return best.used;
  }

 private:
  std::vector<bool> draw() {
    std::vector<std::size_t> order(problem_.samples.size());
    std::iota(order.begin(), order.end(), 0);
    std::vector<bool> used(order.size(), false);
    for (std::size_t n = 0; n < std::min(kStartPoses, order.size()); ++n) {
      const std::size_t left = order.size() - n;
      std::swap(order[n], order[n + static_cast<std::size_t>(random_.uniform() * static_cast<double>(left))]);
      used[order[n]] = true;
    }
    return used;
  }

  /// Fits the poses in use and measures all. A pose in the fit has pulled it: S - G C G^T; one outside has
  /// not: S + G C G^T.
  bool refit(Candidate& candidate, int iterations) {
    const Fit found = fit(objective_, problem_.nominal, {}, candidate.used, iterations);
    ParameterMatrix covariance;
    if (!found.equations.invert(covariance)) return false;
    candidate.machine = found.machine;
    candidate.distances.assign(problem_.samples.size(), std::numeric_limits<double>::infinity());
    PoseTerm term;
    for (std::size_t j = 0; j < problem_.samples.size(); ++j) {
      if (!objective_.term(j, found.machine, term)) continue;
      const Twist& e = objective_.error(j);
      const auto rows = pose_rows(term.at, {});
      const Mat6 predicted = problem_.samples[j].covariance + rows * covariance * rows.transpose();
      // Outside: the distance of an innovation. Inside: that of the residual, which the fit has made smaller.
      candidate.distances[j] = candidate.used[j] ? objective_.distance(j) : e.dot(predicted.llt().solve(e));
    }
    return true;
  }

  /// A C-step: keeps the h nearest, and fits them.
  bool concentrate(Candidate& candidate) {
    std::vector<std::size_t> order(candidate.distances.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return candidate.distances[a] < candidate.distances[b];
    });
    candidate.used.assign(order.size(), false);
    for (std::size_t n = 0; n < core_; ++n) candidate.used[order[n]] = true;
    if (!refit(candidate, kShortFit)) return false;
    candidate.trimmed = 0;
    for (std::size_t j = 0; j < order.size(); ++j)
      if (candidate.used[j]) candidate.trimmed += candidate.distances[j];
    return std::isfinite(candidate.trimmed);
  }

  /// Noise may be understated: then the core itself is spread wider than it says.
  double scale(const Candidate& candidate) const {
    double sum = 0;
    int count = 0;
    for (std::size_t j = 0; j < candidate.used.size(); ++j)
      if (candidate.used[j]) sum += candidate.distances[j], ++count;
    const int degrees = 6 * count - kGeometryParameters;
    return degrees > 0 ? std::max(1.0, sum / degrees) : 1.0;
  }

  void admit(Candidate& best) {
    for (std::size_t round = 0; round <= best.used.size(); ++round) {
      const double limit = kPlausible * scale(best);
      std::size_t nearest = best.used.size();
      for (std::size_t j = 0; j < best.used.size(); ++j)
        if (!best.used[j] && best.distances[j] < limit &&
            (nearest == best.used.size() || best.distances[j] < best.distances[nearest]))
          nearest = j;
      if (nearest == best.used.size()) return;
      best.used[nearest] = true;
      if (!refit(best, options_.max_iterations)) return;
    }
  }

  const Problem& problem_;
  const Options& options_;
  PoseErrorObjective objective_;
  Random random_;
  std::size_t core_ = 0;
};

class Robust final : public Estimator {
 public:
  Calibration calibrate(const Problem& problem, const Options& options) const override {
    const Identifiability found = check_identifiability(problem, {});
    if (found.status != Status::ok) return refused(problem, found.status, found.message);
    const std::vector<bool> used = TrimmedSearch(problem, options).search();
    if (used.empty())
      return refused(problem, Status::not_converged,
                     "no 8 of the poses agree on a machine: check their order");
    PoseErrorObjective objective(problem);
    Calibration result =
        calibrated(problem, fit(objective, problem.nominal, {}, used, options.max_iterations), {}, used);
    result.warnings.insert(result.warnings.begin(), found.warnings.begin(), found.warnings.end());
    std::string rejected;
    for (std::size_t j = 0; j < used.size(); ++j)
      if (!used[j]) rejected += (rejected.empty() ? "" : ", ") + std::to_string(j + 1);
    if (!rejected.empty()) result.warnings.push_back("rejected as outliers: poses " + rejected);
    return result;
  }
};

}  // namespace

std::unique_ptr<Estimator> make_robust() { return std::make_unique<Robust>(); }

}  // namespace understudy::calibration
