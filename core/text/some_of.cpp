#include "core/text/some_of.h"

#include <algorithm>

#include <fmt/ranges.h>

namespace understudy {

std::string some_of(const std::vector<std::string>& list, std::size_t shown) {
  const std::size_t named = std::min(shown, list.size());
  const std::string text =
      fmt::format("{}", fmt::join(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(named), ", "));
  return list.size() > named ? text + fmt::format(" and {} more", list.size() - named) : text;
}

}  // namespace understudy
