// From the filament that the drive has fed to what has left the nozzle.
#pragma once

namespace understudy::sim {

/// A melt column that gives way: what leaves the nozzle follows the feed as a first-order lag, and filament
/// that was drawn back must come forward again before anything flows (nothing is sucked back in).
/// Everything that goes in comes out: fed() - delivered() = column().
class Extruder {
 public:
  /// `lag` [s], 0 or more.
  explicit Extruder(double lag) : lag_(lag) {}

  struct Flow {
    double filament = 0;  ///< [m] of filament that left the nozzle in the interval
    double from = 0;      ///< share of the interval that had passed when it began to flow
  };
  /// The feed goes linearly to `fed` [m, absolute] within `duration` [s].
  Flow advance(double fed, double duration);

  /// [m] of filament: above 0 what still presses to come out, below 0 what was drawn back.
  double column() const { return column_; }

 private:
  Flow advance_full(double rate, double duration);

  double lag_;
  double fed_ = 0;
  double column_ = 0;
};

}  // namespace understudy::sim
