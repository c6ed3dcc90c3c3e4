// Long lists in a line of text.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace understudy {

/// "a, b, c and 44 more": at most `shown` of the list.
std::string some_of(const std::vector<std::string>& list, std::size_t shown);

}  // namespace understudy
