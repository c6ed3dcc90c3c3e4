#include "rehearsal/findings/feature_findings.h"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include "core/text/lower_case.h"

namespace understudy::rehearsal {

namespace {

/// As slicers call what fills a part loosely: "Sparse infill", "Internal infill", "FILL".
bool is_sparse_infill(std::string_view type) {
  const std::string lower = lower_case(type);
  if (lower.find("fill") == std::string::npos) return false;
  constexpr std::array kDense{"solid", "top", "bottom", "bridge", "gap"};
  return std::ranges::none_of(kDense,
                              [&](const char* word) { return lower.find(word) != std::string::npos; });
}

void spare_few_short_strands(const toolpath::FeatureTypes& types, std::vector<Finding>& findings) {
  std::vector<Finding*> sags;
  for (Finding& finding : findings)
    if (finding.kind == "sag" && finding.severity == Severity::error &&
        is_sparse_infill(types.at(finding.gcode_line)))
      sags.push_back(&finding);
  const bool all_short =
      std::ranges::all_of(sags, [](const Finding* finding) { return finding->about == kShortStrand; });
  if (!all_short || sags.size() > kFewStrands) return;
  for (Finding* finding : sags) finding->severity = Severity::warning;
}

}  // namespace

void tell_features(const toolpath::FeatureTypes& types, std::vector<Finding>& findings) {
  for (Finding& finding : findings) {
    const bool of_lines = finding.kind == "adhesion" || finding.kind == "sag";
    const std::string_view type = types.at(finding.gcode_line);
    if (finding.gcode_line == 0 || type.empty() || (!of_lines && finding.kind != "gap")) continue;
    const bool spoils_no_part = of_lines && toolpath::is_beside_part(type);
    finding.message += fmt::format(" ({}{})", type, spoils_no_part ? ", beside the part" : "");
    if (spoils_no_part) finding.severity = Severity::warning;
  }
  spare_few_short_strands(types, findings);
}

}  // namespace understudy::rehearsal
