// Whether the readings follow the tool. Something that shines and stands still in the picture (a thread of
// plastic on the nozzle) reads a gap of its own, and whoever trusts it drives the nozzle into the part. Only
// motion tells the two apart: what the tool may come nearer between two proofs is bounded by these classes.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/gap/confidence.h"

namespace understudy::control {

/// Of an approach: samples from heights that sink.
class ApproachResponseTest {
 public:
  /// `floor` [m] is what must be left in any case; `blind` [m] what may be travelled before the first proof.
  ApproachResponseTest(double floor, double blind) : floor_(floor), blind_(blind) {}

  void restart() { *this = ApproachResponseTest(floor_, blind_); }

  void add(double height, double gap, double sigma) {
    if (!begun_) {
      begun_ = true;
      sure_ = std::min(gap, floor_ + blind_) - height;
      stall_ = last_ = anchor_ = {height, gap, sigma};
      return;
    }
    sure_ = std::min(sure_, gap - height);
    const Sample sample{height, gap, sigma};
    count_stall(sample);
    // Where noise is more than it is told to be, a single step proves nothing and all of them together do.
    // Whichever of two samples was the dot: the lower of their dead reckonings is safe.
    for (const Sample& from : {last_, anchor_}) {
      if (!followed(from, sample)) continue;
      proved_ = true;
      // By the sample before the step: the one after it may be the first at something else.
      sure_ = std::min(from.gap - from.height, gap - height);
      anchor_ = sample;
      break;
    }
    if (evident(last_, sample)) last_ = sample;
  }

  bool proved() const { return proved_; }
  int stalls() const { return stalls_; }  ///< steps in a row that the gap did not follow
  /// How much nearer the tool may come, by the steps made since the last proof [m].
  double room(double height) const { return sure_ + height - floor_; }

 private:
  static constexpr double kStallStep = 15e-6;  // [m], a step whose effect must show
  static constexpr double kStallShare = 0.3;   // of a step: a gap that closes by less has not followed
  static constexpr double kEvident = 6;  // standard deviations of two samples: a third of it may be noise

  struct Sample {
    double height = 0, gap = 0, sigma = 0;
  };

  static double noise(const Sample& a, const Sample& b) { return std::hypot(a.sigma, b.sigma); }
  static bool evident(const Sample& from, const Sample& to) {
    return from.height - to.height >= std::max(kStallStep, kEvident * noise(from, to));
  }
  static bool followed(const Sample& from, const Sample& to) {
    const double moved = from.height - to.height;
    return evident(from, to) &&
           std::abs(from.gap - to.gap - moved) <= kScaleError * moved + kEvident / 3 * noise(from, to);
  }

  /// Steps too small to show add up.
  void count_stall(const Sample& sample) {
    const double moved = stall_.height - sample.height;
    if (moved < kStallStep) return;
    stalls_ = stall_.gap - sample.gap >= kStallShare * moved ? 0 : stalls_ + 1;
    stall_ = sample;
  }

  double floor_, blind_;
  bool begun_ = false, proved_ = false;
  double sure_ = 0;               // [m], gap less height: no more is proved
  Sample stall_, last_, anchor_;  // anchor: at the last proof, or the first
  int stalls_ = 0;
};

/// Of a print: a sequential test (Page's CUSUM) of the follower's line against a reading that stands still.
/// Where nothing but noise is seen, it takes exp(threshold) samples on average to err once.
class CusumTest {
 public:
  /// From here: so far the readings have followed.
  void restart(double correction) {
    highest_ = correction;
    forget();
  }
  /// The reading has changed for a reason of its own.
  void forget() {
    variance_ = std::numeric_limits<double>::infinity();
    evidence_ = 0;
  }
  /// A reading `reading` [m] of `variance` [m^2]; the follower's line missed it by `miss`, with `total`
  /// [m^2] of variance in all. True: the readings follow.
  bool observe(double reading, double variance, double miss, double total) {
    if (!std::isfinite(reading)) {
      forget();
      return false;
    }
    if (std::isinf(variance_)) {
      level_ = reading;
      variance_ = variance;
      return false;
    }
    const double still = reading - level_, still_total = variance_ + variance;
    const double standing = still * still / still_total, following = miss * miss / total;
    // Readings that scatter more than they state fit neither, and one of them proves nothing.
    scatter_ += (std::min(standing, following) - scatter_) / kScatterReadings;
    const double gain =
        0.5 * ((standing - following) / std::max(1.0, scatter_) + std::log(still_total) - std::log(total));
    evidence_ = std::max(0.0, evidence_ + gain);
    level_ += variance_ / still_total * still;
    variance_ *= variance / still_total;
    return evidence_ >= kThreshold;
  }

  /// Called with every correction that is commanded.
  void reach(double correction) { highest_ = std::max(highest_, correction); }
  double highest() const { return highest_; }  ///< [m], of the corrections since the last proof

 private:
  static constexpr double kThreshold = 10;  // exp(10) samples are nine minutes
  static constexpr double kScatterReadings = 8;

  double level_ = 0;
  double variance_ = std::numeric_limits<double>::infinity();
  double evidence_ = 0;
  double scatter_ = 1;  // of the better explanation's misses, in variances, over the last readings
  double highest_ = 0;
};

}  // namespace understudy::control
