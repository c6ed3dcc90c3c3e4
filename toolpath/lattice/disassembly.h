// In which order a frame can be taken apart so that what is left always stands: a search that backtracks.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "toolpath/lattice/lattice.h"

namespace understudy::toolpath {

/// A strut as it is taken off: it was printed from node `from`.
struct Removal {
  int strut = 0, from = 0, to = 0;
};

struct DisassemblyRules {
  /// Whether the strut could be printed last, from that node on, with `standing` (by strut, this one left
  /// out) around it. What is possible must stay so when fewer stand.
  std::function<bool(const Removal& removal, const std::vector<char>& standing)> removable;
  std::function<void()> put_back = {};  ///< told when the search goes back and more stand again
  /// Where the search is stuck: a removal to make all the same, or false. Left out: none.
  std::function<bool(const std::vector<Removal>& anchored, const std::vector<char>& standing,
                     Removal& forced)>
      force = {};
  std::function<bool()> out_of_time = {};  ///< asked at every step
  long steps_max = 200'000;                ///< struts taken off in all, those that were put back included
};

enum class DisassemblyEnd {
  found,
  // Both proven where taking struts away never blocks another. Struts that begin on top of a grounded one,
  // and travel that was not found, which is tried again only once the highest strut is gone, are rare
  // exceptions.
  blocked,   ///< of what is left none can come off, whatever else were supported
  no_order,  ///< every order was tried
  out_of_steps,
  out_of_time,
};

struct Disassembly {
  DisassemblyEnd end = DisassemblyEnd::found;
  std::vector<Removal> removals;  ///< whole where found, else those of the longest attempt
  std::vector<int> left;          ///< what stood then
  long steps = 0;
};

/// Every strut is taken off once, begun at a node that is grounded or that another standing strut touches,
/// and the rest stays connected to the ground. The highest strut is tried first; of those as high, the one
/// that lies highest as a whole, then the one whose end is nearest to where the print goes on after it. Where
/// no strut can come off, the last decision is changed; sets of struts from which nothing led on are
/// remembered. After some attempts the search begins anew and takes those off earlier that were the last
/// support of others then. The same frame gives the same order.
Disassembly take_apart(const Lattice& lattice, const DisassemblyRules& rules);

}  // namespace understudy::toolpath
