#include "toolpath/inspection/told_beads.h"

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <string>

#include "core/text/lower_case.h"
#include "core/text/trimmed.h"
#include "core/units.h"
#include "toolpath/inspection/comments.h"
#include "toolpath/inspection/feature_types.h"

namespace understudy::toolpath {
namespace {

constexpr double kThickest = 10, kWidest = 100;  // [mm], that is believed

/// [m]; nothing where the comment says something else, or no length that a bead can have.
std::optional<double> length_after(std::string_view comment, std::string_view key, double most) {
  if (!comment.starts_with(key)) return std::nullopt;
  const std::string_view text = trimmed(comment.substr(key.size()));
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !(value > 0 && value <= most)) return std::nullopt;
  return from_mm(value);
}

void take(std::string_view comment, ToldBead& bead) {
  for (const char* key : {"HEIGHT:", "LAYER_HEIGHT:"})
    if (const auto height = length_after(comment, key, kThickest)) bead.height = *height;
  for (const char* key : {"WIDTH:", "LINE_WIDTH:"})
    if (const auto width = length_after(comment, key, kWidest)) bead.width = *width;
}

bool has_word(std::string_view type, std::initializer_list<const char*> words) {
  const std::string lower = lower_case(type);
  return std::ranges::any_of(words, [&](const char* word) { return lower.find(word) != std::string::npos; });
}

}  // namespace

double ToldBead::area() const {
  return height > 0 && width >= height ? (width - height) * height + std::numbers::pi / 4 * height * height
                                       : 0;
}

ToldBeads::ToldBeads(std::string_view text) {
  const FeatureTypes types(text);
  ToldBead told, in_force;  // as the comments say, and what is meant of it
  for_each_comment(text, [&](int line, std::string_view comment) {
    take(comment, told);
    const std::string_view type = types.at(line);
    supports_ = supports_ || has_word(type, {"support"});
    const ToldBead now = has_word(type, {"bridge", "overhang", "ironing"}) ? ToldBead{} : told;
    if (now.height == in_force.height && now.width == in_force.width) return;
    from_.emplace_back(line, in_force = now);
  });
}

ToldBead ToldBeads::at(int line) const {
  const auto next = std::upper_bound(from_.begin(), from_.end(), line,
                                     [](int l, const auto& from) { return l < from.first; });
  return next == from_.begin() ? ToldBead() : std::prev(next)->second;
}

}  // namespace understudy::toolpath
