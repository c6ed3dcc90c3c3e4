#include "toolpath/lattice/lattice_sequence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/lattice/disassembly.h"
#include "toolpath/lattice/lattice_access.h"
#include "toolpath/planners/plan_checks.h"

namespace understudy::toolpath {
namespace {

constexpr std::size_t kLookedAt = 16;                   // removals that an error chooses from
constexpr std::array<double, 2> kLessPress = {0.5, 0};  // of what is allowed at joints, worse first
constexpr double kAloneDone = 0.1, kOrderDone = 0.6;    // of the work, as progress tells it

class Sequence {
 public:
  Sequence(const Lattice& lattice, const SequenceLimits& limits)
      : lattice_(lattice), limits_(limits), access_(lattice, limits), prints_(lattice.struts.size()) {}

  StrutSequence run() {
    require_each_alone();
    DisassemblyRules rules;
    rules.removable = [this](const Removal& removal, const std::vector<char>& standing) {
      StrutPrint print;
      if (!access_.find(removal, standing, print)) return false;
      tell_order(standing);
      prints_[static_cast<std::size_t>(removal.strut)] = std::move(print);
      return true;
    };
    rules.put_back = [this] { access_.put_back(); };
    if (limits_.accept_interference)
      rules.force = [this](const auto& removals, const auto& standing, Removal& forced) {
        return force(removals, standing, forced);
      };
    rules.out_of_time = limits_.out_of_time;
    rules.steps_max = limits_.steps_max;
    const Disassembly found = take_apart(lattice_, rules);
    if (found.end != DisassemblyEnd::found) throw InputError(refusal(found));
    leave_room(found);
    StrutSequence sequence;
    sequence.steps = found.steps;
    for (auto it = found.removals.rbegin(); it != found.removals.rend(); ++it)
      sequence.prints.push_back(std::move(prints_[static_cast<std::size_t>(it->strut)]));
    sequence.warnings.assign(warnings_.rbegin(), warnings_.rend());
    return sequence;
  }

 private:
  struct Nearest {
    Removal removal;
    StrutPrint print;
    StrutAccess::Obstacle obstacle;
  };

  // The search goes back and forth: the farthest that it was.
  void tell_order(const std::vector<char>& standing) {
    off_ = std::max(off_, static_cast<std::size_t>(std::count(standing.begin(), standing.end(), 0)));
    tell(stage_of(limits_.progress, kAloneDone, kOrderDone), off_, standing.size(), "finding an order");
  }

  // The order is found with joints pressed as deep as is allowed. A machine errs, so where another axis
  // presses less, that one is taken: the same struts stand then.
  void leave_room(const Disassembly& found) {
    if (limits_.joint_press <= 0) return;
    const Progress progress = stage_of(limits_.progress, kOrderDone, 1);
    std::size_t done = 0;
    for (const double share : kLessPress) {
      SequenceLimits limits = limits_;
      limits.joint_press *= share;
      StrutAccess access(lattice_, limits);
      std::vector<char> standing(lattice_.struts.size(), 1);
      for (const Removal& removal : found.removals) {
        const auto strut = static_cast<std::size_t>(removal.strut);
        standing[strut] = 0;
        if (limits_.out_of_time && limits_.out_of_time()) return;
        tell(progress, ++done, kLessPress.size() * found.removals.size(), "leaving room at joints");
        StrutPrint print;
        if (access.find(removal, standing, print)) prints_[strut] = std::move(print);
      }
    }
  }

  // What no order can help is told before the search.
  void require_each_alone() const {
    std::string why;
    for (int s = 0; s < static_cast<int>(lattice_.struts.size()); ++s) {
      if (limits_.out_of_time && limits_.out_of_time())
        throw InputError("the time allowed (--time-limit) is over before the search for an order began");
      tell(stage_of(limits_.progress, 0, kAloneDone), static_cast<std::size_t>(s), lattice_.struts.size(),
           "looking at each strut alone");
      if (access_.never(s, why)) throw InputError(name(s) + no_axis() + "can print it: " + why);
    }
  }

  // Of the first removals the one that the tool comes least near to.
  std::optional<Nearest> nearest(const std::vector<Removal>& removals,
                                 const std::vector<char>& standing) const {
    std::optional<Nearest> best;
    for (std::size_t i = 0; i < std::min(removals.size(), kLookedAt); ++i) {
      std::vector<char> others = standing;
      others[static_cast<std::size_t>(removals[i].strut)] = 0;
      StrutPrint print;
      StrutAccess::Obstacle obstacle = access_.clearest(removals[i], others, print);
      if (!best || obstacle.lack < best->obstacle.lack)
        best = {removals[i], std::move(print), std::move(obstacle)};
    }
    return best;
  }

  bool force(const std::vector<Removal>& removals, const std::vector<char>& standing, Removal& forced) {
    std::optional<Nearest> best = nearest(removals, standing);
    if (!best || best->obstacle.strut < 0) return false;
    forced = best->removal;
    access_.complete_anyhow(best->print);
    warnings_.push_back(reason(*best));
    prints_[static_cast<std::size_t>(forced.strut)] = std::move(best->print);
    return true;
  }

  std::string refusal(const Disassembly& found) const {
    std::vector<char> standing(lattice_.struts.size());
    std::vector<Removal> removals;
    for (const int s : found.left) {
      standing[static_cast<std::size_t>(s)] = 1;
      const auto& [a, b] = lattice_.struts[static_cast<std::size_t>(s)];
      removals.push_back({s, a, b});
      removals.push_back({s, b, a});
    }
    const std::optional<Nearest> best = nearest(removals, standing);
    const std::string strut = best ? reason(*best) : "";
    const std::string left = fmt::format("; the longest attempt left {} of {} struts; of these ",
                                         found.left.size(), lattice_.struts.size());
    switch (found.end) {
      case DisassemblyEnd::no_order:
        return "no order keeps every strut supported and clear, all were tried" + left + strut;
      case DisassemblyEnd::out_of_steps:
        return fmt::format("no order was found within {} steps", limits_.steps_max) + left + strut;
      case DisassemblyEnd::out_of_time:
        return "no order was found in the time allowed (--time-limit)" + left + strut;
      default:
        return strut;
    }
  }

  std::string name(int strut) const {
    const auto& [a, b] = lattice_.struts[static_cast<std::size_t>(strut)];
    return fmt::format("strut {} from {} to {}: ", strut,
                       in_mm(lattice_.nodes[static_cast<std::size_t>(a)].position),
                       in_mm(lattice_.nodes[static_cast<std::size_t>(b)].position));
  }
  std::string no_axis() const {
    return fmt::format("no tool axis within {:g} deg of vertical ", to_deg(limits_.tilt_max));
  }
  std::string reason(const Nearest& n) const {
    if (n.obstacle.strut < 0 && n.obstacle.why.empty())
      return name(n.removal.strut) + "it is the last support of others";
    if (n.obstacle.strut < 0) return name(n.removal.strut) + no_axis() + "can print it: " + n.obstacle.why;
    return name(n.removal.strut) + no_axis() +
           fmt::format("is clear; at best the tool comes to {:.3f} mm from strut {}, the limit is {:.3f} mm",
                       to_mm(n.obstacle.distance), n.obstacle.strut, to_mm(n.obstacle.limit));
  }

  const Lattice& lattice_;
  const SequenceLimits& limits_;
  StrutAccess access_;
  std::vector<StrutPrint> prints_;  // by strut: how it comes off
  std::vector<std::string> warnings_;
  std::size_t off_ = 0;  // struts that were off at once, so far
};

}  // namespace

void check_sequence(const Lattice& lattice, const SequenceLimits& limits) {
  check_positive("strut diameter", to_mm(limits.strut_diameter), "mm");
  check_positive("nozzle flat", to_mm(limits.nozzle_flat), "mm");
  check_positive("gap at the ground", to_mm(limits.ground_gap), "mm");
  check_positive("margin", to_mm(limits.margin), "mm");
  check_positive("joint", to_mm(limits.joint), "mm");
  check_within("press at joints", to_mm(limits.joint_press), 0, 10, "mm");
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

StrutSequence sequence_struts(const Lattice& lattice, const SequenceLimits& limits) {
  check_sequence(lattice, limits);
  return Sequence(lattice, limits).run();
}

}  // namespace understudy::toolpath
