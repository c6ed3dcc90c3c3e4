#include "toolpath/inspection/feature_types.h"

#include <algorithm>
#include <array>

#include "core/text/lower_case.h"
#include "core/text/trimmed.h"
#include "toolpath/inspection/comments.h"

namespace understudy::toolpath {
namespace {

std::string_view after(std::string_view comment, std::string_view key) {
  return comment.starts_with(key) ? trimmed(comment.substr(key.size())) : "";
}

/// Empty where the comment names none.
std::string_view type_of(std::string_view comment) {
  for (const char* key : {"TYPE:", "FEATURE:", "feature "})
    if (const auto type = after(comment, key); !type.empty()) return type;
  constexpr std::string_view kKisslicerEnd = " Path'";
  const std::size_t end = comment.find(kKisslicerEnd);
  return comment.starts_with('\'') && end != std::string_view::npos ? comment.substr(1, end - 1) : "";
}

}  // namespace

FeatureTypes::FeatureTypes(std::string_view text) {
  for_each_comment(text, [this](int line, std::string_view comment) {
    const std::string_view type = type_of(comment);
    if (!type.empty() && (from_.empty() || from_.back().second != type)) from_.emplace_back(line, type);
  });
}

int FeatureTypes::first_of_part() const {
  const auto first =
      std::ranges::find_if(from_, [](const auto& from) { return !is_beside_part(from.second); });
  return first == from_.end() ? 0 : first->first;
}

std::string_view FeatureTypes::at(int line) const {
  const auto next = std::upper_bound(from_.begin(), from_.end(), line,
                                     [](int l, const auto& from) { return l < from.first; });
  return next == from_.begin() ? std::string_view() : std::string_view(std::prev(next)->second);
}

bool is_beside_part(std::string_view type) {
  const std::string lower = lower_case(type);
  // "Custom" is PrusaSlicer's word for the start and end blocks of a printer, which draw its purge line.
  constexpr std::array kWords{"skirt", "brim", "custom", "wipe tower", "prime", "purge", "ooze shield"};
  return std::ranges::any_of(kWords, [&](const char* word) { return lower.find(word) != std::string::npos; });
}

std::map<std::string, double> feature_lengths(const Program& program, const FeatureTypes& types,
                                              const Vec3& start_W) {
  std::map<std::string, double> lengths;
  Vec3 tip = start_W;
  for (const Step& step : program.steps) {
    if (!moves(step)) continue;
    const Vec3 end = step.X_WT.translation();
    const std::string_view type = types.at(step.line);
    if (step.kind == StepKind::print && !type.empty()) lengths[std::string(type)] += (end - tip).norm();
    tip = end;
  }
  return lengths;
}

}  // namespace understudy::toolpath
