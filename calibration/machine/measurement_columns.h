// The columns of a table of measured poses.
#pragma once

#include <string>
#include <vector>

#include "machine/description.h"

namespace understudy::calibration {

/// How a file tells the noise of its poses.
enum class NoiseColumns { none, isotropic, axes, full };

const std::vector<std::string>& pose_columns();
/// "l1_mm" or "j1_deg": the machine's axes.
std::vector<std::string> axis_columns(const machine::MachineDescription& machine);
/// "a1" to "a6"
const std::vector<std::string>& approach_columns();
const std::vector<std::string>& noise_columns(NoiseColumns kind);
/// "frame_um", "frame_mrad", "frame_permille": of the measuring device, the same in every row
const std::vector<std::string>& frame_columns();
/// SI value of one unit of a noise column, of a standard deviation or an entry of the covariance.
double noise_unit(const std::string& column);

/// What a header holds. Throws InputError at `place` for columns that are missing, unknown or given twice,
/// and for noise that is told twice or in part.
struct TableColumns {
  NoiseColumns noise = NoiseColumns::none;
  bool approach = false;
  bool frame = false;
};
TableColumns check_columns(const std::vector<std::string>& header, const machine::MachineDescription& machine,
                           const std::string& file, int line);

}  // namespace understudy::calibration
