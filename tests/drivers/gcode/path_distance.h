// How far a place is from a path that runs straight from point to point, about a time.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace understudy::drivers {

struct TimedPoint {
  double time = 0;
  std::vector<double> at;  ///< each coordinate in units of its tolerance
};

/// The least distance within `late` of the point's time; before and after the path, from its ends.
inline double path_distance(const TimedPoint& point, const std::vector<TimedPoint>& path, double late) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t n = 1; n < path.size(); ++n) {
    const TimedPoint &a = path[n - 1], &b = path[n];
    const bool first = n == 1, last = n + 1 == path.size();
    if ((!first && point.time + late < a.time) || (!last && point.time - late > b.time)) continue;
    double along = 0, length = 0;
    for (std::size_t i = 0; i < a.at.size(); ++i) {
      along += (point.at[i] - a.at[i]) * (b.at[i] - a.at[i]);
      length += (b.at[i] - a.at[i]) * (b.at[i] - a.at[i]);
    }
    const double span = b.time - a.time;
    const double low = std::clamp((point.time - late - a.time) / span, 0.0, 1.0);
    const double high = std::clamp((point.time + late - a.time) / span, 0.0, 1.0);
    const double share = length > 0 ? std::clamp(along / length, low, high) : low;
    double square = 0;
    for (std::size_t i = 0; i < a.at.size(); ++i)
      square += std::pow(point.at[i] - a.at[i] - share * (b.at[i] - a.at[i]), 2);
    best = std::min(best, std::sqrt(square));
  }
  return best;
}

}  // namespace understudy::drivers
