#include "toolpath/lattice/disassembly.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <tuple>
#include <unordered_set>

#include "core/interrupt.h"
#include "core/units.h"

namespace understudy::toolpath {
namespace {

constexpr long kFirstRound = 64;  // steps back before the search begins anew; doubled each time

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class Search {
 public:
  Search(const Lattice& lattice, const DisassemblyRules& rules)
      : lattice_(lattice),
        rules_(rules),
        touching_(lattice.nodes.size()),
        degree_(lattice.nodes.size()),
        standing_(lattice.struts.size(), 1),
        boost_(lattice.struts.size()),
        left_(lattice.struts.size()) {
    std::mt19937_64 bits(20210131);
    for (std::size_t s = 0; s < lattice.struts.size(); ++s) {
      key_.push_back(bits());
      hash_ ^= key_.back();
      for (const int node : lattice.struts[s]) {
        touching_[at(node)].push_back(static_cast<int>(s));
        ++degree_[at(node)];
      }
    }
  }

  Disassembly run() {
    for (long backs = kFirstRound;; backs *= 2) {
      order_struts();
      levels_.push_back({});
      if (attempt(backs)) return std::move(best_);
    }
  }

 private:
  // One decision: where in the order the search is, and what it took.
  struct Level {
    std::size_t group = 0, tried = 0;
    Removal taken{-1};
    bool forced = false;
  };

  // True when there is an answer.
  bool attempt(long backs) {
    while (true) {
      stop_if_interrupted();
      if (rules_.out_of_time && rules_.out_of_time()) return end(DisassemblyEnd::out_of_time);
      if (best_.steps >= rules_.steps_max) return end(DisassemblyEnd::out_of_steps);
      if (left_ == 0) return end(DisassemblyEnd::found);
      if (!dead_.contains(hash_) && advance()) continue;
      if (none_comes_off_) return end(DisassemblyEnd::blocked);
      dead_.insert(hash_);
      levels_.pop_back();
      if (levels_.empty()) return end(DisassemblyEnd::no_order);
      restore(levels_.back().taken.strut);
      if (--backs == 0) {
        restore_all();
        return false;
      }
    }
  }

  // Takes the next strut that comes off here; false when there is none.
  bool advance() {
    Level& level = levels_.back();
    if (level.forced) return false;
    const bool fresh = level.group == 0 && level.tried == 0;
    for (; level.group < groups_.size(); ++level.group, level.tried = 0) {
      const std::vector<Removal> removals = removals_of(groups_[level.group]);
      while (level.tried < removals.size()) {
        const Removal& removal = removals[level.tried++];
        if (removal.strut == level.taken.strut || !comes_off(removal)) continue;
        take(removal);
        return true;
      }
    }
    if (!fresh || level.taken.strut >= 0) return false;
    note_longest();
    none_comes_off_ = !support_alone_holds();
    if (!rules_.force) return false;
    Removal forced;
    none_comes_off_ = false;
    if (!rules_.force(supported(), standing_, forced)) return false;
    level.forced = true;
    take(forced);
    return true;
  }

  bool comes_off(const Removal& removal) {
    standing_[at(removal.strut)] = 0;
    const bool yes = stays_connected(removal.strut) && rules_.removable(removal, standing_);
    standing_[at(removal.strut)] = 1;
    return yes;
  }

  // At a dead end: whether some strut could come off if support did not matter. If none could, none of these
  // ever comes off before another one of them. The ones that could are taken earlier in later attempts.
  bool support_alone_holds() {
    bool any = false;
    for (std::size_t s = 0; s < standing_.size(); ++s) {
      if (!standing_[s]) continue;
      const auto [a, b] = lattice_.struts[s];
      standing_[s] = 0;
      const int strut = static_cast<int>(s);
      const bool free =
          rules_.removable({strut, a, b}, standing_) || rules_.removable({strut, b, a}, standing_);
      standing_[s] = 1;
      if (free) ++boost_[s];
      any = any || free;
    }
    return any;
  }

  std::vector<Removal> supported() {
    std::vector<Removal> removals;
    for (const auto& group : groups_)
      for (const Removal& removal : removals_of(group)) {
        standing_[at(removal.strut)] = 0;
        if (stays_connected(removal.strut)) removals.push_back(removal);
        standing_[at(removal.strut)] = 1;
      }
    return removals;
  }

  void note_longest() {
    if (!best_.left.empty() && best_.left.size() <= left_) return;
    best_.removals.clear();
    for (const Level& level : levels_)
      if (level.taken.strut >= 0) best_.removals.push_back(level.taken);
    best_.left.clear();
    for (const auto& group : groups_)
      for (const int s : group)
        if (standing_[at(s)]) best_.left.push_back(s);
  }

  bool end(DisassemblyEnd how) {
    best_.end = how;
    if (how == DisassemblyEnd::found) {
      left_ = 0;
      best_.left.assign(1, -1);
      note_longest();
    } else if (best_.left.empty()) {
      note_longest();
    }
    return true;
  }

  void take(const Removal& removal) {
    levels_.back().taken = removal;
    standing_[at(removal.strut)] = 0;
    for (const int node : lattice_.struts[at(removal.strut)]) --degree_[at(node)];
    hash_ ^= key_[at(removal.strut)];
    --left_;
    ++best_.steps;
    levels_.push_back({});
  }
  void restore(int strut) {
    standing_[at(strut)] = 1;
    for (const int node : lattice_.struts[at(strut)]) ++degree_[at(node)];
    hash_ ^= key_[at(strut)];
    ++left_;
    if (rules_.put_back) rules_.put_back();
  }
  void restore_all() {
    for (const Level& level : levels_)
      if (level.taken.strut >= 0 && !standing_[at(level.taken.strut)]) restore(level.taken.strut);
    levels_.clear();
  }

  // Struts of one height together, highest first. [um]: heights are equal where they are to a drive.
  void order_struts() {
    const auto rank = [&](int s) {
      const auto& [a, b] = lattice_.struts[at(s)];
      const double z_a = lattice_.nodes[at(a)].position.z(), z_b = lattice_.nodes[at(b)].position.z();
      return std::tuple(-boost_[at(s)], -std::lround(to_um(std::max(z_a, z_b))),
                        -std::lround(to_um(std::min(z_a, z_b))));
    };
    std::vector<int> order(lattice_.struts.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int l, int r) { return rank(l) < rank(r); });
    groups_.clear();
    for (const int s : order) {
      if (groups_.empty() || rank(groups_.back().front()) != rank(s)) groups_.emplace_back();
      groups_.back().push_back(s);
    }
  }

  std::vector<Removal> removals_of(const std::vector<int>& group) const {
    std::vector<std::tuple<long, int, int, int>> found;  // travel [um], strut, from, to
    const int next = levels_.size() > 1 ? levels_[levels_.size() - 2].taken.from : -1;
    for (const int s : group) {
      if (!standing_[at(s)]) continue;
      const auto& [a, b] = lattice_.struts[at(s)];
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
        if (!lattice_.nodes[at(from)].grounded && degree_[at(from)] < 2) continue;
        const double travel =
            next < 0 ? 0 : (lattice_.nodes[at(to)].position - lattice_.nodes[at(next)].position).norm();
        found.emplace_back(std::lround(to_um(travel)), s, from, to);
      }
    }
    std::sort(found.begin(), found.end());
    std::vector<Removal> removals;
    for (const auto& [travel, s, from, to] : found) removals.push_back({s, from, to});
    return removals;
  }

  // Without `strut`, which stood until now: whether both of its ends still reach the ground.
  bool stays_connected(int strut) {
    const auto& [a, b] = lattice_.struts[at(strut)];
    return reaches_ground(a) && reaches_ground(b);
  }

  bool reaches_ground(int start) {
    if (lattice_.nodes[at(start)].grounded || degree_[at(start)] < 2) return true;
    seen_.assign(lattice_.nodes.size(), 0);
    open_.assign(1, start);
    seen_[at(start)] = 1;
    while (!open_.empty()) {
      const int node = open_.back();
      open_.pop_back();
      for (const int s : touching_[at(node)]) {
        if (!standing_[at(s)]) continue;
        const auto& [a, b] = lattice_.struts[at(s)];
        const int other = a == node ? b : a;
        if (lattice_.nodes[at(other)].grounded) return true;
        if (seen_[at(other)]) continue;
        seen_[at(other)] = 1;
        open_.push_back(other);
      }
    }
    return false;
  }

  const Lattice& lattice_;
  const DisassemblyRules& rules_;
  std::vector<std::vector<int>> touching_;  // struts at each node
  std::vector<int> degree_;                 // standing ones
  std::vector<char> standing_;
  std::vector<int> boost_;  // of each strut: how often it was the last support of others at a dead end
  std::size_t left_;
  std::vector<std::vector<int>> groups_;
  std::vector<Level> levels_;
  std::vector<std::uint64_t> key_;
  std::uint64_t hash_ = 0;
  std::unordered_set<std::uint64_t> dead_;
  bool none_comes_off_ = false;
  Disassembly best_;
  std::vector<char> seen_;
  std::vector<int> open_;
};

}  // namespace

Disassembly take_apart(const Lattice& lattice, const DisassemblyRules& rules) {
  return Search(lattice, rules).run();
}

}  // namespace understudy::toolpath
