// The unit of a number in a file, by the suffix of its key.
#pragma once

#include <string_view>

namespace understudy {

struct KeyUnit {
  std::string_view suffix;  ///< "_mm"
  std::string_view name;    ///< as messages add it to a number: " mm"
  double si;                ///< what one is in SI
};

/// Without name, and 1, for a key that has no unit.
KeyUnit unit_of(std::string_view key);

}  // namespace understudy
