#include "rehearsal/findings/start_block.h"

#include <algorithm>

#include "toolpath/inspection/comments.h"
#include "toolpath/inspection/layer_comments.h"

namespace understudy::rehearsal {
namespace {

constexpr double kTouch_mm = 0.05;  // what a table gives way by

bool meets_what_was_purged(const Finding& finding, int end) {
  return finding.kind == "collision" && finding.about == "nozzle and bead" && finding.bead_line > 0 &&
         finding.bead_line < end;
}

bool is_purged(const Finding& finding) {
  if (finding.kind == "adhesion" || finding.kind == "sag") return true;
  return finding.kind == "collision" && finding.about == "nozzle and table" && -finding.value <= kTouch_mm;
}

}  // namespace

int start_block_end(std::string_view text, const toolpath::FeatureTypes& features) {
  int end = 0;
  const auto may_end = [&end](int line) {
    if (line > 0 && (end == 0 || line < end)) end = line;
  };
  may_end(toolpath::LayerComments(text).first());
  may_end(features.first_of_part());
  toolpath::for_each_comment(text, [&](int line, std::string_view comment) {
    if (comment.starts_with("<IceSL ")) may_end(line);
  });
  return end;
}

void tell_start_block(int end, std::vector<Finding>& findings) {
  for (Finding& finding : findings) {
    if (finding.severity != Severity::error) continue;
    const bool before = finding.gcode_line > 0 && finding.gcode_line < end && is_purged(finding);
    if (!before && !meets_what_was_purged(finding, end)) continue;
    finding.severity = Severity::warning;
    finding.message += before ? " (before the first layer)" : " (laid before the first layer)";
  }
}

}  // namespace understudy::rehearsal
