// What a light guide makes solid, told to an observer of deposition as if it had been fed.
#pragma once

#include <functional>
#include <optional>

#include "machine/cure.h"
#include "sim/observer.h"

namespace understudy::sim {

/// While the program feeds, the light is on. Each snapshot goes on with the volume by then cured in place of
/// the filament fed: the section of a line at the true speed of the tip, no deeper than the gap. The light is
/// all of this instant: lines beside each other do not add up, and resin that stands still hardens as at
/// `kSlowest`.
class CuringObserver : public Observer {
 public:
  static constexpr double kSlowest = 1e-5;  ///< [m/s]

  /// `gap` [m]: of the deposition by now; infinite with nothing below. `next` gets the snapshots and outlives
  /// this one.
  CuringObserver(const machine::Cure& cure, double filament_area, std::function<double()> gap, Observer& next)
      : cure_(cure), filament_area_(filament_area), gap_(std::move(gap)), next_(next) {}

  void observe(const Snapshot& snapshot) override;

  /// [m], of a line at the tip's speed over the last interval: what lies deeper is not reached.
  double depth() const { return cure_.depth(speed_); }

 private:
  machine::Cure cure_;
  double filament_area_;  // [m^2]
  std::function<double()> gap_;
  Observer& next_;
  std::optional<Snapshot> last_;
  double speed_ = kSlowest;  // [m/s]
  double cured_ = 0;         // [m^3]
};

}  // namespace understudy::sim
