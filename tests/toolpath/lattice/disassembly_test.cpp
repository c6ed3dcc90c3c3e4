#include "toolpath/lattice/disassembly.h"

#include <algorithm>
#include <array>
#include <bit>
#include <set>

#include <gtest/gtest.h>

#include "core/random.h"

namespace understudy::toolpath {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// A strut from a node on may come off once none of these stands; in the other direction likewise.
struct Blockers {
  std::array<bool, 2> ever{true, true};
  std::array<std::set<int>, 2> by;
};

struct Puzzle {
  Lattice lattice;
  std::vector<Blockers> blockers;

  int direction(const Removal& r) const { return lattice.struts[at(r.strut)][0] == r.from ? 0 : 1; }
  bool free(const Removal& r, const std::vector<char>& standing) const {
    const auto& b = blockers[at(r.strut)];
    const auto d = at(direction(r));
    return b.ever[d] && std::none_of(b.by[d].begin(), b.by[d].end(), [&](int s) { return standing[at(s)]; });
  }
  DisassemblyRules rules() const {
    DisassemblyRules rules;
    rules.removable = [this](const Removal& r, const std::vector<char>& standing) {
      EXPECT_FALSE(standing[at(r.strut)]);
      return free(r, standing);
    };
    return rules;
  }
};

bool supported(const Lattice& lattice, int node, unsigned printed) {
  if (lattice.nodes[at(node)].grounded) return true;
  for (std::size_t s = 0; s < lattice.struts.size(); ++s)
    if (printed >> s & 1u && (lattice.struts[s][0] == node || lattice.struts[s][1] == node)) return true;
  return false;
}

std::vector<char> as_standing(std::size_t count, unsigned printed) {
  std::vector<char> standing(count);
  for (std::size_t s = 0; s < count; ++s) standing[s] = printed >> s & 1u;
  return standing;
}

// Forwards, through every set of struts: which sets can be printed at all.
bool some_order_exists(const Puzzle& puzzle) {
  const std::size_t n = puzzle.lattice.struts.size();
  std::vector<bool> reached(std::size_t{1} << n);
  reached[0] = true;
  for (unsigned printed = 0; printed + 1 < reached.size(); ++printed) {
    if (!reached[printed]) continue;
    for (int s = 0; s < static_cast<int>(n); ++s) {
      if (printed >> s & 1u) continue;
      const auto [a, b] = puzzle.lattice.struts[at(s)];
      for (const Removal& r : {Removal{s, a, b}, Removal{s, b, a}})
        if (supported(puzzle.lattice, r.from, printed) && puzzle.free(r, as_standing(n, printed)))
          reached[printed | 1u << s] = true;
    }
  }
  return reached.back();
}

void expect_valid(const Puzzle& puzzle, const Disassembly& found) {
  const std::size_t n = puzzle.lattice.struts.size();
  ASSERT_EQ(found.removals.size(), n);
  unsigned printed = 0;
  for (auto r = found.removals.rbegin(); r != found.removals.rend(); ++r) {
    EXPECT_TRUE(supported(puzzle.lattice, r->from, printed));
    EXPECT_TRUE(puzzle.free(*r, as_standing(n, printed)));
    printed |= 1u << r->strut;
  }
  EXPECT_EQ(std::popcount(printed), static_cast<int>(n));
}

// Two legs and a beam on them.
Puzzle portal() {
  Puzzle p;
  p.lattice.nodes = {{Vec3(0, 0, 0), true},
                     {Vec3(0, 0, 0.01), false},
                     {Vec3(0.01, 0, 0), true},
                     {Vec3(0.01, 0, 0.01), false}};
  p.lattice.struts = {{0, 1}, {2, 3}, {1, 3}};
  p.blockers.resize(3);
  return p;
}

TEST(Disassembly, GoesBackWhereTheHighestStrutWasTheWrongOne) {
  // The second leg can be printed downwards only. The beam is highest; taken off first, it leaves that leg's
  // upper end without support.
  Puzzle p = portal();
  p.blockers[1].ever = {false, true};
  ASSERT_TRUE(some_order_exists(p));
  const Disassembly found = take_apart(p.lattice, p.rules());
  ASSERT_EQ(found.end, DisassemblyEnd::found);
  expect_valid(p, found);
  EXPECT_EQ(found.removals.front().strut, 1);
  EXPECT_EQ(found.removals.front().from, 3);
  EXPECT_GT(found.steps, 3);  // went back
}

TEST(Disassembly, ProvesThatThereIsNoOrder) {
  // Both legs can be printed downwards only.
  Puzzle p = portal();
  p.blockers[0].ever = p.blockers[1].ever = {false, true};
  ASSERT_FALSE(some_order_exists(p));
  EXPECT_EQ(take_apart(p.lattice, p.rules()).end, DisassemblyEnd::no_order);
  // Each leg is in the other's way: whatever held them up.
  p = portal();
  p.blockers[0].by = {std::set{1}, std::set{1}};
  p.blockers[1].by = {std::set{0}, std::set{0}};
  ASSERT_FALSE(some_order_exists(p));
  const Disassembly blocked = take_apart(p.lattice, p.rules());
  EXPECT_EQ(blocked.end, DisassemblyEnd::blocked);
  std::vector<int> left = blocked.left;
  std::sort(left.begin(), left.end());
  EXPECT_EQ(left, (std::vector{0, 1}));
}

TEST(Disassembly, EndsWithinItsStepsAndItsTime) {
  Puzzle p = portal();
  p.blockers[0].ever = p.blockers[1].ever = {false, true};
  DisassemblyRules rules = p.rules();
  rules.steps_max = 1;
  EXPECT_EQ(take_apart(p.lattice, rules).end, DisassemblyEnd::out_of_steps);
  rules.out_of_time = [] { return true; };
  EXPECT_EQ(take_apart(p.lattice, rules).end, DisassemblyEnd::out_of_time);
}

// Connected to the ground, with up to 9 struts, and everything in the way of everything now and then.
Puzzle random_puzzle(Random& random) {
  const auto pick = [&](int n) { return std::min(n - 1, static_cast<int>(random.uniform(0, n))); };
  Puzzle p;
  const int nodes = 4 + pick(3);
  for (int i = 0; i < nodes; ++i)
    p.lattice.nodes.push_back({Vec3(0.01 * i, 0, i < 2 ? 0 : 0.01 * (1 + pick(3))), i < 2});
  std::set<std::array<int, 2>> struts;
  for (int i = 2; i < nodes; ++i) struts.insert({pick(i), i});
  for (int k = 0; k < 4; ++k)
    if (const int a = pick(nodes), b = pick(nodes); a < b && b > 1) struts.insert({a, b});
  p.lattice.struts.assign(struts.begin(), struts.end());
  const int n = static_cast<int>(p.lattice.struts.size());
  p.blockers.resize(at(n));
  for (int s = 0; s < n; ++s)
    for (std::size_t d = 0; d < 2; ++d) {
      p.blockers[at(s)].ever[d] = random.uniform(0, 1) < 0.7;
      for (int k = 0; k < 2; ++k)
        if (const int other = pick(n); other != s && random.uniform(0, 1) < 0.5)
          p.blockers[at(s)].by[d].insert(other);
    }
  return p;
}

TEST(Disassembly, FindsAnOrderWhereverOneExists) {
  Random random(20220101, "puzzles");
  int found_some = 0, went_back = 0, none = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    const Puzzle p = random_puzzle(random);
    const Disassembly found = take_apart(p.lattice, p.rules());
    ASSERT_EQ(found.end == DisassemblyEnd::found, some_order_exists(p));
    if (found.end == DisassemblyEnd::found) {
      expect_valid(p, found);
      ++found_some;
      went_back += found.steps > static_cast<long>(p.lattice.struts.size());
    } else {
      EXPECT_TRUE(found.end == DisassemblyEnd::no_order || found.end == DisassemblyEnd::blocked);
      ++none;
    }
  }
  EXPECT_GT(found_some, 100);
  EXPECT_GT(went_back, 20);
  EXPECT_GT(none, 100);
}

}  // namespace
}  // namespace understudy::toolpath
