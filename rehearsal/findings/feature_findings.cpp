#include "rehearsal/findings/feature_findings.h"

#include <fmt/format.h>

namespace understudy::rehearsal {

void tell_features(const toolpath::FeatureTypes& types, std::vector<Finding>& findings) {
  for (Finding& finding : findings) {
    const bool of_lines = finding.kind == "adhesion" || finding.kind == "sag";
    const std::string_view type = types.at(finding.gcode_line);
    if (finding.gcode_line == 0 || type.empty() || (!of_lines && finding.kind != "gap")) continue;
    const bool spoils_no_part = of_lines && toolpath::is_beside_part(type);
    finding.message += fmt::format(" ({}{})", type, spoils_no_part ? ", beside the part" : "");
    if (spoils_no_part) finding.severity = Severity::warning;
  }
}

}  // namespace understudy::rehearsal
