// Sobol indices of groups of inputs from a pick-freeze design: which share of an output's variance a group
// causes alone, and which with all that it interacts with.
#pragma once

#include <cstdint>
#include <vector>

namespace understudy::studies {

/// Outputs of pairs of independent inputs; every vector has one entry a pair, at least two.
struct PickFreeze {
  std::vector<double> a, b;                ///< of the one and of the other
  std::vector<std::vector<double>> mixed;  ///< by group: of `a` with this group's inputs from `b`
};

/// Between `low` and `high` lies the truth, with the level that was asked for.
struct SobolIndex {
  double value = 0, low = 0, high = 0;
};

/// Of one group, 0 to 1; estimates scatter beyond.
struct GroupShare {
  SobolIndex first;  ///< S: of the variance that would go with this group known
  SobolIndex total;  ///< T: of the variance that would stay with all others known
};

struct Bootstrap {
  int resamples = 1000;
  double level = 0.95;
  std::uint64_t seed = 1;
};

/// Both indices of each group by the estimators of Jansen 1999 (Saltelli 2010, table 2, c and f), with the
/// variance from the same pairs: S = 1 - <(b - m)^2> / <(b - a)^2>, T = <(a - m)^2> / <(b - a)^2>. So they
/// are 1 exactly where nothing but the group matters, and 0 exactly where it does not. Intervals are the
/// percentiles of a bootstrap over the pairs. Empty where the output does not vary.
std::vector<GroupShare> sobol_indices(const PickFreeze& outputs, const Bootstrap& bootstrap = {});

}  // namespace understudy::studies
