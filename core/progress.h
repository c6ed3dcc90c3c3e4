// How far a long task is, for whoever shows it.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace understudy {

/// Share done of the whole task, 0..1, and what is being done. Empty: nobody looks.
using Progress = std::function<void(double share, const std::string& what)>;

/// For a stage that is the share `from` to `to` of the task that `progress` is of.
inline Progress stage_of(const Progress& progress, double from, double to) {
  if (!progress) return {};
  return [progress, from, to](double share, const std::string& what) {
    progress(from + (to - from) * share, what);
  };
}

/// Says that `done` of `all` of something is done, where anybody looks.
inline void tell(const Progress& progress, std::size_t done, std::size_t all, const std::string& what) {
  if (progress) progress(static_cast<double>(done) / static_cast<double>(all), what);
}

}  // namespace understudy
