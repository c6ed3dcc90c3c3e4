#include "toolpath/lattice/lattice_sequence.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/lattice/lattice_access.h"
#include "toolpath/planners/plan_checks.h"

namespace understudy::toolpath {
namespace {

constexpr int kLookedAt = 16;  // candidates that an error chooses from

// The frame while it is taken apart.
class Disassembly {
 public:
  Disassembly(const Lattice& lattice, const SequenceLimits& limits)
      : lattice_(lattice), limits_(limits), access_(lattice, limits), touching_(lattice.nodes.size()) {
    for (int s = 0; s < static_cast<int>(lattice.struts.size()); ++s) {
      standing_.push_back(s);
      for (const int node : lattice.struts[s]) touching_[node].push_back(s);
    }
    is_standing_.assign(standing_.size(), true);
  }

  StrutSequence run() {
    StrutSequence sequence;
    while (!standing_.empty()) {
      const std::vector<Candidate> candidates = last_ones();
      StrutPrint print;
      if (!take_clear(candidates, print)) print = take_clearest(candidates, sequence.warnings);
      sequence.prints.push_back(print);
      next_from_ = print.from;
    }
    std::reverse(sequence.prints.begin(), sequence.prints.end());
    std::reverse(sequence.warnings.begin(), sequence.warnings.end());
    return sequence;
  }

 private:
  struct Candidate {
    int strut, from, to;
    long top, bottom;  // [um]: heights are equal where they are to a drive
    double travel;     // [m], from its end to where the print goes on after it
  };

  // Highest first; of equals the one that lies highest as a whole, then the one nearest to what comes after.
  std::vector<Candidate> last_ones() const {
    std::vector<Candidate> candidates;
    for (const int s : standing_) {
      const auto& [a, b] = lattice_.struts[s];
      const double z_a = lattice_.nodes[a].position.z(), z_b = lattice_.nodes[b].position.z();
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
        if (!anchored(from, s)) continue;
        const double travel =
            next_from_ < 0 ? 0 : (lattice_.nodes[to].position - lattice_.nodes[next_from_].position).norm();
        candidates.push_back({s, from, to, std::lround(to_um(std::max(z_a, z_b))),
                              std::lround(to_um(std::min(z_a, z_b))), travel});
      }
    }
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& l, const Candidate& r) {
      if (l.top != r.top) return l.top > r.top;
      if (l.bottom != r.bottom) return l.bottom > r.bottom;
      const long travel_l = std::lround(to_um(l.travel)), travel_r = std::lround(to_um(r.travel));
      if (travel_l != travel_r) return travel_l < travel_r;
      return std::pair(l.strut, l.from) < std::pair(r.strut, r.from);
    });
    return candidates;
  }

  bool anchored(int node, int without) const {
    if (lattice_.nodes[node].grounded) return true;
    return std::any_of(touching_[node].begin(), touching_[node].end(),
                       [&](int s) { return s != without && is_standing_[s]; });
  }

  bool take_clear(const std::vector<Candidate>& candidates, StrutPrint& print) {
    int bridge = -1;
    for (const Candidate& c : candidates) {
      if (c.strut == bridge) continue;
      take(c.strut);
      if (!connected())
        bridge = c.strut;
      else if (access_.find(c.strut, c.from, c.to, standing_, print))
        return true;
      put_back(c.strut);
    }
    return false;
  }

  // Of the first candidates the one that the tool comes least near to; refused unless that is accepted.
  StrutPrint take_clearest(const std::vector<Candidate>& candidates, std::vector<std::string>& warnings) {
    std::optional<StrutPrint> best;
    StrutAccess::Obstacle obstacle;
    int looked_at = 0;
    for (const Candidate& c : candidates) {
      if (looked_at == kLookedAt) break;
      take(c.strut);
      if (connected()) {
        ++looked_at;
        StrutPrint print;
        const auto nearest = access_.clearest(c.strut, c.from, c.to, standing_, print);
        if (!best || nearest.distance > obstacle.distance) {
          obstacle = nearest;
          best = print;
          best->strut = c.strut;
        }
      }
      put_back(c.strut);
    }
    if (!best) throw InputError("no strut can be taken off without the others losing their ground");
    const std::string message = reason(best->strut, obstacle);
    if (!std::isfinite(obstacle.distance) || !limits_.accept_interference) throw InputError(message);
    warnings.push_back(message);
    take(best->strut);
    return *best;
  }

  std::string reason(int strut, const StrutAccess::Obstacle& obstacle) const {
    const auto& [a, b] = lattice_.struts[strut];
    const std::string which = fmt::format(
        "strut {} from {} to {}: no tool axis within {:g} deg of vertical is ", strut,
        in_mm(lattice_.nodes[a].position), in_mm(lattice_.nodes[b].position), to_deg(limits_.tilt_max));
    if (!std::isfinite(obstacle.distance)) return which + "above the table and in reach";
    const std::string near =
        obstacle.strut == strut ? "the strand itself" : fmt::format("strut {}", obstacle.strut);
    return which + fmt::format("clear; at best the tool comes to {:.2f} mm from {}, the limit is {:.2f} mm",
                               to_mm(obstacle.distance), near, to_mm(limits_.margin));
  }

  void take(int strut) {
    is_standing_[strut] = false;
    standing_.erase(std::lower_bound(standing_.begin(), standing_.end(), strut));
  }
  void put_back(int strut) {
    is_standing_[strut] = true;
    standing_.insert(std::lower_bound(standing_.begin(), standing_.end(), strut), strut);
  }

  bool connected() const {
    std::vector<bool> reached(standing_.empty() ? 0 : is_standing_.size());
    std::vector<int> open;
    std::size_t count = 0;
    const auto reach = [&](int s) {
      if (reached[s] || !is_standing_[s]) return;
      reached[s] = true;
      ++count;
      open.push_back(s);
    };
    for (const int s : standing_)
      for (const int node : lattice_.struts[s])
        if (lattice_.nodes[node].grounded) reach(s);
    while (!open.empty()) {
      const int s = open.back();
      open.pop_back();
      for (const int node : lattice_.struts[s])
        for (const int other : touching_[node]) reach(other);
    }
    return count == standing_.size();
  }

  const Lattice& lattice_;
  const SequenceLimits& limits_;
  StrutAccess access_;
  std::vector<std::vector<int>> touching_;  // struts at each node
  std::vector<int> standing_;               // sorted
  std::vector<bool> is_standing_;
  int next_from_ = -1;  // node at which the strut printed after begins
};

void check(const Lattice& lattice, const SequenceLimits& limits) {
  check_positive("strut diameter", to_mm(limits.strut_diameter), "mm");
  check_positive("gap at the ground", to_mm(limits.ground_gap), "mm");
  check_positive("margin", to_mm(limits.margin), "mm");
  check_positive("joint", to_mm(limits.joint), "mm");
  check_positive("lift", to_mm(limits.lift), "mm");
  check_within("largest tilt", to_deg(limits.tilt_max), 0, 90 + 1e-9, "deg");
  if (lattice.struts.empty()) throw InputError("the lattice has 0 struts, it needs 1");
  const std::vector<int> hanging = hanging_nodes(lattice);
  if (!hanging.empty())
    throw InputError(fmt::format("node {} and {} more are not connected to a grounded node", hanging.front(),
                                 hanging.size() - 1));
  for (std::size_t n = 0; n < lattice.nodes.size(); ++n)
    if (const Vec3& p = lattice.nodes[n].position; p.z() < 0.5 * limits.strut_diameter - kMicrometre)
      throw InputError(fmt::format("node {} at {} is lower than half a strut above the table, {:.3f} mm", n,
                                   in_mm(p), to_mm(0.5 * limits.strut_diameter)));
}

}  // namespace

Vec3 tip_at(const LatticeNode& node, const Vec3& axis, double strut_diameter, double ground_gap) {
  if (node.grounded) return node.position + (ground_gap - 0.5 * strut_diameter) * Vec3::UnitZ();
  return node.position + 0.5 * strut_diameter * axis;
}

StrutSequence sequence_struts(const Lattice& lattice, const SequenceLimits& limits) {
  check(lattice, limits);
  return Disassembly(lattice, limits).run();
}

}  // namespace understudy::toolpath
