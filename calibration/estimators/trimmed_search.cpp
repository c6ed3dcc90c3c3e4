#include "calibration/estimators/trimmed_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/random.h"

namespace understudy::calibration {
namespace {

constexpr int kStarts = 60;           // of which 99 % hit 8 good poses when a quarter of 24 are bad: 1 in 16
constexpr double kStartsDone = 0.5;   // of the work, as progress tells it
constexpr std::size_t kBest = 5;      // starts that are followed to the end
constexpr int kShortFit = 6;          // iterations
constexpr double kGoodShare = 0.75;   // of the poses, at least, are taken for good
constexpr double kPlausible = 22.46;  // 0.999 quantile of chi-square with 6 degrees of freedom
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Candidate {
  std::vector<bool> used;
  std::vector<double> distances;
  double trimmed = kInfinity;
};

class Search {
 public:
  Search(PoseFit& model, const TrimmedSearch& setting)
      : model_(model),
        setting_(setting),
        start_(std::min(start_poses(setting.parameters), setting.poses)),
        random_(setting.seed, "robust calibration") {
    const auto good = static_cast<std::size_t>(std::ceil(kGoodShare * static_cast<double>(setting.poses)));
    core_ = std::min(std::max(start_poses(setting.parameters), good), setting.poses);
  }

  std::vector<bool> run() {
    std::vector<Candidate> all;
    for (int n = 0; n < kStarts; ++n) {
      Candidate candidate;
      candidate.used = draw();
      if (refit(candidate, kShortFit) && concentrate(candidate) && concentrate(candidate))
        all.push_back(std::move(candidate));
      tell(stage_of(setting_.progress, 0, kStartsDone), static_cast<std::size_t>(n + 1), kStarts,
           "fits to a few poses");
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Candidate& a, const Candidate& b) { return a.trimmed < b.trimmed; });
    Candidate best;
    for (std::size_t n = 0; n < std::min(kBest, all.size()); ++n) {
      double before = kInfinity;
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
    std::vector<std::size_t> order(setting_.poses);
    std::iota(order.begin(), order.end(), 0);
    std::vector<bool> used(order.size(), false);
    for (std::size_t n = 0; n < start_; ++n) {
      const std::size_t left = order.size() - n;
      std::swap(order[n], order[n + static_cast<std::size_t>(random_.uniform() * static_cast<double>(left))]);
      used[order[n]] = true;
    }
    return used;
  }

  bool refit(Candidate& candidate, int iterations) {
    return model_.fit(candidate.used, iterations, candidate.distances);
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
    const int degrees = 6 * count - setting_.parameters;
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
      tell(stage_of(setting_.progress, kStartsDone, 1), round, best.used.size() - core_ + 1,
           "poses that join");
      best.used[nearest] = true;
      if (!refit(best, setting_.iterations)) return;
    }
  }

  PoseFit& model_;
  TrimmedSearch setting_;
  std::size_t start_, core_ = 0;
  Random random_;
};

}  // namespace

std::size_t start_poses(int parameters) { return static_cast<std::size_t>(parameters + 5) / 6 + 1; }

std::vector<bool> agreeing_poses(PoseFit& model, const TrimmedSearch& search) {
  return Search(model, search).run();
}

std::string rejection_warning(const std::vector<bool>& used) {
  std::string rejected;
  for (std::size_t j = 0; j < used.size(); ++j)
    if (!used[j]) rejected += (rejected.empty() ? "" : ", ") + std::to_string(j + 1);
  return rejected.empty() ? rejected : "rejected as outliers: poses " + rejected;
}

}  // namespace understudy::calibration
