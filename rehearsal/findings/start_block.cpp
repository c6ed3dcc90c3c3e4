#include "rehearsal/findings/start_block.h"

#include <cctype>
#include <cstdlib>
#include <optional>
#include <string>

#include "toolpath/gcode/gcode_line_reader.h"
#include "toolpath/inspection/feature_types.h"

namespace understudy::rehearsal {
namespace {

constexpr double kTouch_mm = 0.05;  // what a table gives way by

/// What the word says after `begin`, if it begins so.
std::optional<std::string> after(const std::string& word, std::string_view begin) {
  if (!word.starts_with(begin)) return std::nullopt;
  return word.substr(begin.size());
}

/// Layers are counted from 0 or 1, those of a raft from below; a higher number is not the first.
bool is_first(const std::string& number) {
  char* end = nullptr;
  const long layer = std::strtol(number.c_str(), &end, 10);
  return end != number.c_str() && layer <= 1;
}

bool begins_the_part(std::string_view comment) {
  std::string word;
  for (const char c : comment)
    if (!word.empty() || c != ' ') word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const char* begin : {"layer_change", "change_layer", "<icesl "})
    if (word.starts_with(begin)) return true;
  for (const char* layer : {"layer:", "layer "})
    if (const auto number = after(word, layer)) return is_first(*number);
  for (const char* feature : {"type:", "feature:"})
    if (const auto type = after(word, feature)) return !toolpath::is_beside_part(*type);
  return false;
}

/// Of the bead that a contact names; 0: it names none.
int line_of_bead(const Finding& contact) {
  constexpr std::string_view kNamed = "bead of line ";
  const std::size_t at = contact.message.find(kNamed);
  return at == std::string::npos ? 0 : std::atoi(contact.message.c_str() + at + kNamed.size());
}

bool meets_what_was_purged(const Finding& finding, int end) {
  if (finding.kind != "collision" || finding.about != "nozzle and bead") return false;
  const int line = line_of_bead(finding);
  return line > 0 && line < end;
}

bool is_purged(const Finding& finding) {
  if (finding.kind == "adhesion" || finding.kind == "sag") return true;
  return finding.kind == "collision" && finding.about == "nozzle and table" && -finding.value <= kTouch_mm;
}

}  // namespace

int start_block_end(std::string_view text) {
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view row = toolpath::take_line(text);
    if (row.starts_with(';') && begins_the_part(row.substr(1))) return line;
  }
  return 0;
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
