#include "toolpath/gcode/rewrite/rewritten_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text/take_line.h"
#include "toolpath/gcode/gcode_line_reader.h"
#include "toolpath/gcode/rewrite/gcode_rewrite.h"

namespace understudy::toolpath {
namespace {

void note_poses(const Program& program, const Pose& X_WT_home, std::vector<Pose>& begin,
                std::vector<Pose>& end) {
  Pose at = X_WT_home;
  for (const Step& step : program.steps) {
    begin.push_back(at);
    if (moves(step)) at = step.X_WT;
    end.push_back(at);
  }
}

/// Steps of each line, in order: lines of a program ascend.
std::map<int, std::pair<std::size_t, std::size_t>> steps_by_line(const Program& program) {
  std::map<int, std::pair<std::size_t, std::size_t>> lines;
  for (std::size_t i = 0; i < program.steps.size(); ++i) {
    auto& [first, count] = lines.try_emplace(program.steps[i].line, i, 0).first->second;
    count = i + 1 - first;
  }
  return lines;
}

/// Where along a straight move a tip is, 0 to 1.
double projected(const Vec3& from, const Vec3& to, const Vec3& p) {
  const Vec3 way = to - from;
  const double length2 = way.squaredNorm();
  return length2 > 0 ? std::clamp((p - from).dot(way) / length2, 0.0, 1.0) : 1;
}

}  // namespace

RewrittenPath::RewrittenPath(const Program& original, const Program& rewritten, const std::string& text,
                             const Pose& X_WT_home)
    : original_lines_{0}, file_(rewritten.file) {
  note_poses(original, X_WT_home, begin_, end_);
  note_poses(rewritten, X_WT_home, rewritten_begin_, rewritten_end_);
  int line_of_original = 0;
  for (std::string_view rest = text; !rest.empty();)
    original_lines_.push_back(is_continuation(take_line(rest)) ? line_of_original : ++line_of_original);
  match(original, rewritten);
}

double RewrittenPath::length(std::size_t step) const {
  return (end_[step].translation() - begin_[step].translation()).norm();
}

void RewrittenPath::match(const Program& original, const Program& rewritten) {
  const auto lines = steps_by_line(original);
  parts_.resize(rewritten.steps.size());
  for (std::size_t i = 0; i < rewritten.steps.size();) {
    const int line = original_line(rewritten.steps[i].line);
    const auto steps = lines.find(line);
    if (steps == lines.end())
      throw InputError(
          Place{file_, rewritten.steps[i].line},
          fmt::format("this line does something, line {} of {} does not: the one was not made of "
                      "the other",
                      line, original.file));
    const auto [first, count] = steps->second;
    std::size_t last = i;
    double filament = 0, way = 0;
    for (; last < rewritten.steps.size() && original_line(rewritten.steps[last].line) == line; ++last) {
      filament += std::abs(rewritten.steps[last].filament);
      way += (rewritten_end_[last].translation() - rewritten_begin_[last].translation()).norm();
    }
    double done = 0;
    for (; i < last; ++i) {
      const double moved = (rewritten_end_[i].translation() - rewritten_begin_[i].translation()).norm();
      const double share = filament > 0 ? std::abs(rewritten.steps[i].filament) / filament
                           : way > 0    ? moved / way
                                        : 1;
      parts_[i] = {first, count, done, std::min(1.0, done + share)};
      done = parts_[i].to;
      if (moves(rewritten.steps[i])) by_line_.emplace(rewritten.steps[i].line, i);
    }
  }
}

AskedPlace RewrittenPath::place(std::size_t step, double fraction) const {
  const Part& part = parts_[step];
  const double share = part.from + fraction * (part.to - part.from);
  double whole = 0;
  for (std::size_t k = 0; k < part.count; ++k) whole += length(part.first + k);
  if (part.count == 1 || whole == 0) return {part.first + part.count - 1, part.count == 1 ? share : 1};
  double left = share * whole;
  for (std::size_t k = 0; k < part.count; ++k) {
    const double along = length(part.first + k);
    if (left <= along || k + 1 == part.count)
      return {part.first + k, along > 0 ? std::min(1.0, left / along) : 1};
    left -= along;
  }
  return {part.first, share};
}

Pose RewrittenPath::asked(const AskedPlace& place) const {
  return interpolate(begin_[place.step], end_[place.step], place.fraction);
}

Pose RewrittenPath::asked(int line, const Pose& X_WT) const {
  const auto [first, last] = by_line_.equal_range(line);
  if (first == last) return X_WT;
  double nearest = std::numeric_limits<double>::infinity(), fraction = 0;
  std::size_t best = first->second;
  for (auto step = first; step != last; ++step) {
    const Vec3 from = rewritten_begin_[step->second].translation();
    const Vec3 to = rewritten_end_[step->second].translation();
    const double share = projected(from, to, X_WT.translation());
    const double off = (from + share * (to - from) - X_WT.translation()).squaredNorm();
    if (off > nearest) continue;
    nearest = off;
    fraction = share;
    best = step->second;
  }
  return asked(place(best, fraction));
}

int RewrittenPath::original_line(int line) const {
  const auto at = static_cast<std::size_t>(line);
  return at < original_lines_.size() ? original_lines_[at] : line;
}

}  // namespace understudy::toolpath
