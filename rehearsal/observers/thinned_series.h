// A series of unknown length in bounded memory, at even steps.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace understudy::rehearsal {

/// Keeps at most `capacity` points, two at least: when they are full, every other one of them goes, and from
/// then on twice as few are added.
template <typename Point>
class ThinnedSeries {
 public:
  explicit ThinnedSeries(std::size_t capacity) : capacity_(std::max<std::size_t>(2, capacity)) {
    points_.reserve(capacity_);
  }

  void add(const Point& point) {
    if (count_++ % stride_ != 0) return;
    if (points_.size() >= capacity_) {
      std::size_t kept = 0;
      for (std::size_t i = 0; i < points_.size(); i += 2) points_[kept++] = points_[i];
      points_.resize(kept);
      stride_ *= 2;
      if ((count_ - 1) % stride_ != 0) return;
    }
    points_.push_back(point);
  }

  const std::vector<Point>& points() const { return points_; }
  std::vector<Point> take() { return std::move(points_); }
  std::uint64_t count() const { return count_; }    ///< that were added
  std::uint64_t stride() const { return stride_; }  ///< of these, a point that is kept

 private:
  std::size_t capacity_;
  std::uint64_t stride_ = 1, count_ = 0;
  std::vector<Point> points_;
};

}  // namespace understudy::rehearsal
