#include "report/video/captions.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace understudy::report {
namespace {

constexpr std::size_t kCaptionsMost = 2;

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; }

}  // namespace

std::string in_ascii(const std::string& text) {
  static constexpr std::array<std::pair<const char*, const char*>, 6> kSigns{
      {{"µ", "u"}, {"μ", "u"}, {"°", " deg"}, {"×", "x"}, {"–", "-"}, {"−", "-"}}};
  std::string ascii;
  for (std::size_t i = 0; i < text.size();) {
    const auto sign = std::ranges::find_if(kSigns, [&](const auto& each) {
      return text.compare(i, std::string(each.first).size(), each.first) == 0;
    });
    if (sign != kSigns.end()) {
      ascii += sign->second;
      i += std::string(sign->first).size();
      continue;
    }
    const auto c = static_cast<unsigned char>(text[i]);
    ascii += c >= 0x20 && c < 0x7f ? text[i] : '?';
    for (++i; i < text.size() && continues(text[i]);) ++i;
  }
  return ascii;
}

std::vector<Caption> captions_at(const std::vector<rehearsal::FindingGroup>& findings, double time,
                                 double shown_for) {
  std::vector<const rehearsal::FindingGroup*> seen;
  for (const auto& group : findings)
    if (group.worst.time_s <= time && time - group.worst.time_s <= shown_for) seen.push_back(&group);
  std::ranges::stable_sort(seen,
                           [](const auto* a, const auto* b) { return a->worst.time_s > b->worst.time_s; });
  if (seen.size() > kCaptionsMost) seen.resize(kCaptionsMost);
  std::vector<Caption> captions;
  for (const auto* group : seen) {
    const rehearsal::Finding& finding = group->worst;
    const std::string where = finding.gcode_line > 0 ? fmt::format("line {}: ", finding.gcode_line) : "";
    captions.push_back({in_ascii(where + finding.kind + ": " + finding.message),
                        finding.severity == rehearsal::Severity::error});
  }
  return captions;
}

}  // namespace understudy::report
