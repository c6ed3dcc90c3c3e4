#include "report/picture/joined_beads.h"

#include <algorithm>

#include "core/frames.h"

namespace understudy::report {
namespace {

constexpr std::size_t kMost = 64;  // beads of one piece: the cost of each grows with those before

Vec3 vector_of(const std::array<float, 3>& p) { return Vec3(p[0], p[1], p[2]); }

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double length2 = way.squaredNorm();
  const double share = length2 > 0 ? std::clamp((p - a).dot(way) / length2, 0.0, 1.0) : 0;
  return (p - a - share * way).norm();
}

bool alike(float a, float b) { return std::abs(a - b) <= kJoinedShare * std::max(a, b); }

/// The beads that one piece stands for.
class Run {
 public:
  explicit Run(const sim::Bead& first) : piece_(first), first_(first), passed_{vector_of(first.to_W)} {}

  bool take(const sim::Bead& next) {
    const Vec3 from = vector_of(next.from_W), to = vector_of(next.to_W), begin = vector_of(first_.from_W);
    if (passed_.size() == kMost || !alike(next.width, first_.width) || !alike(next.height, first_.height) ||
        (from - passed_.back()).norm() > kJoinedOff)
      return false;
    const auto beside = [&](const Vec3& p) { return distance_to_segment(p, begin, to) > kJoinedOff; };
    if (std::any_of(passed_.begin(), passed_.end(), beside)) return false;
    passed_.push_back(to);
    piece_.to_W = next.to_W;
    piece_.laid_at = next.laid_at;
    return true;
  }
  const sim::Bead& piece() const { return piece_; }

 private:
  sim::Bead piece_, first_;
  std::vector<Vec3> passed_;  // ends of its beads
};

}  // namespace

std::vector<sim::Bead> joined_beads(const sim::BeadIndex& beads, double by) {
  std::vector<sim::Bead> pieces;
  std::vector<Run> run;  // the last, at most one
  for (std::size_t i = 0; i < beads.size(); ++i) {
    const sim::Bead bead = beads.bead(i);
    if (static_cast<double>(bead.laid_at) > by) break;
    if (!run.empty() && run.back().take(bead)) continue;
    if (!run.empty()) pieces.push_back(run.back().piece());
    run.assign(1, Run(bead));
  }
  if (!run.empty()) pieces.push_back(run.back().piece());
  return pieces;
}

}  // namespace understudy::report
