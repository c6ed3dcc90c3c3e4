#include "report/gltf/tracks.h"

#include <cmath>

#include <gtest/gtest.h>

namespace understudy::report {
namespace {

/// A place that swings, and stands still for the last third.
PlaceTrack swing() {
  PlaceTrack track;
  for (int i = 0; i <= 3000; ++i) {
    const double t = 0.002 * i, s = std::min(t, 4.0);
    track.times.push_back(t);
    track.places.emplace_back(0.02 * std::sin(s), 0.01 * s, 0);
  }
  return track;
}

Vec3 place_at(const PlaceTrack& track, double time) {
  std::size_t k = 0;
  while (k + 2 < track.times.size() && track.times[k + 1] <= time) ++k;
  const double share = (time - track.times[k]) / (track.times[k + 1] - track.times[k]);
  return track.places[k] + share * (track.places[k + 1] - track.places[k]);
}

TEST(Tracks, PlacesKeepTheirBoundWithFewKeys) {
  const PlaceTrack all = swing();
  for (const double error : {5e-6, 50e-6}) {
    const PlaceTrack kept = thinned(all, error);
    EXPECT_LT(kept.times.size(), all.times.size() / 10);
    EXPECT_EQ(kept.times.back(), all.times.back());
    double worst = 0;
    for (std::size_t i = 0; i < all.times.size(); ++i)
      worst = std::max(worst, (place_at(kept, all.times[i]) - all.places[i]).norm());
    EXPECT_LE(worst, error * (1 + 1e-9));
    EXPECT_GT(worst, 0.5 * error) << "more keys than are needed";
  }
}

TEST(Tracks, TurnsKeepTheirBound) {
  TurnTrack all;
  for (int i = 0; i <= 2000; ++i) {
    const double t = 0.002 * i;
    all.times.push_back(t);
    all.turns.emplace_back(Eigen::AngleAxisd(std::sin(t), Vec3(1, 0.3 * std::sin(2 * t), 0).normalized()));
    if (i % 3 == 0) all.turns.back().coeffs() *= -1;  // the same turn
  }
  const TurnTrack kept = thinned(all, 1e-4);
  EXPECT_LT(kept.times.size(), all.times.size() / 4);
  std::size_t k = 0;
  for (std::size_t i = 0; i < all.times.size(); ++i) {
    while (k + 2 < kept.times.size() && kept.times[k + 1] <= all.times[i]) ++k;
    const double share = (all.times[i] - kept.times[k]) / (kept.times[k + 1] - kept.times[k]);
    EXPECT_LE(kept.turns[k].slerp(share, kept.turns[k + 1]).angularDistance(all.turns[i]), 1.001e-4);
  }
}

TEST(Tracks, WhatDoesNotMoveAsFarHasOneKeyTheLast) {
  PlaceTrack still{{0, 1, 2}, {Vec3(0, 0, 0), Vec3(4e-6, 0, 0), Vec3(2e-6, 0, 0)}};
  const PlaceTrack kept = thinned(still, 5e-6);
  ASSERT_EQ(kept.times.size(), 1u);
  EXPECT_EQ(kept.times[0], 2);
  EXPECT_EQ(kept.places[0].x(), 2e-6);
  EXPECT_EQ(thinned(still, 1e-6).times.size(), 3u);
}

}  // namespace
}  // namespace understudy::report
