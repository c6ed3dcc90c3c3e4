#include "report/page/page_parts.h"

namespace understudy::report {

std::string_view dygraphs_version() {
  constexpr std::string_view kMark = "VERSION=\"";
  const std::size_t mark = kDygraphScript.find(kMark);
  if (mark == std::string_view::npos) return "unknown";
  const std::string_view rest = kDygraphScript.substr(mark + kMark.size());
  return rest.substr(0, rest.find('"'));
}

}  // namespace understudy::report
