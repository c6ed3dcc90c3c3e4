// Whether rows of measurements say that an axis of a chain counts the other way.
#pragma once

#include <optional>
#include <string>

#include "calibration/rows/calibrate_rows.h"

namespace understudy::calibration {

/// An axis whose readings, negated, leave a third of the residuals at most.
struct TurnedAxis {
  std::string name;
  double before = 0, after = 0;  ///< [m] or [rad], residuals of the first part as read and negated
  bool angle = false;            ///< of `before` and `after`
};

/// Looks only where `found` leaves residuals that no arm in order has: more than 2 mm or 10 mrad RMS.
std::optional<TurnedAxis> turned_axis(const RowProblem& problem, const RowCalibration& found);

}  // namespace understudy::calibration
