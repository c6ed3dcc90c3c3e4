// From setpoints to the blocks of a controller that interpolates linearly: as few as keep to the path.
//
// A block runs all axes and the filament at constant speed from where the one before ended, in its duration.
// For every sample of the path the block passes, within the time tolerance of the sample's time, within the
// position tolerance of its place. Blocks end on samples; the longest that fits is taken, then the next.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "machine/port.h"

namespace understudy::drivers {

/// A place of the planned path.
struct PathSample {
  double time = 0;                 ///< [s]
  machine::AxisVector position{};  ///< [m or rad]
  double filament = 0;             ///< [m]
  int line = 0;                    ///< G-code line of the program
  std::uint64_t executed = 0;      ///< setpoints that are executed once the machine is here
};

struct Block {
  double duration = 0;             ///< [s]
  machine::AxisVector position{};  ///< [m or rad], at its end, on the grid
  double filament = 0;             ///< [m], at its end, on the grid
  int line = 0;
  std::uint64_t executed = 0;  ///< setpoints, once it is done
  bool rests = false;          ///< nothing moves
};

struct FitTolerance {
  double length = 2e-6;         ///< [m], of the point of all sliding axes
  double angle = 2e-5;          ///< [rad], of that of all turning axes: 2 um at 100 mm
  double filament = 5e-6;       ///< [m]
  double time = 1e-3;           ///< [s]
  double block_time_max = 1.0;  ///< [s], of one block
};

/// What the numbers of a block are rounded to.
struct BlockGrid {
  machine::AxisVector axes{};  ///< [m or rad]
  double filament = 1e-8;      ///< [m]
};

class BlockFitter {
 public:
  /// `turns`: which axes turn; as many as there are axes. The grid counts towards the tolerance.
  BlockFitter(const FitTolerance& tolerance, const BlockGrid& grid, std::vector<bool> turns);

  /// The machine rests there; what was not taken is dropped.
  void begin(const PathSample& at);
  /// Later than the one before; after begin().
  void add(const PathSample& sample);
  /// Nothing follows for now: what is pending becomes blocks.
  void finish();
  /// The next block that is settled.
  std::optional<Block> take();
  /// [s], of the path that is in no block yet
  double pending() const { return samples_.back().time - samples_.front().time; }

 private:
  bool fits(std::size_t last) const;
  std::size_t longest(std::size_t good, std::size_t bad) const;
  void settle();
  void emit(std::size_t last);

  FitTolerance tolerance_;
  BlockGrid grid_;
  std::vector<bool> turns_;
  machine::AxisVector weight_{};     ///< of an axis: its tolerance is 1
  PathSample from_;                  ///< on the grid, where the next block begins
  std::vector<PathSample> samples_;  ///< the path from there on
  std::size_t good_ = 0;             ///< a block to this sample fits
  std::size_t next_ = 1;             ///< to be tried
  std::vector<Block> blocks_;        ///< settled; taken from the front
  std::size_t taken_ = 0;
};

}  // namespace understudy::drivers
