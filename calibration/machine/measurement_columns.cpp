#include "calibration/machine/measurement_columns.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/file/number_table.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

using Words = std::vector<std::string>;

bool contains(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

Words missing(const Words& wanted, const Words& header) {
  Words absent;
  std::copy_if(wanted.begin(), wanted.end(), std::back_inserter(absent),
               [&](const std::string& word) { return !contains(header, word); });
  return absent;
}

/// Upper triangle of the covariance of (x, y, z, rx, ry, rz).
Words covariance_columns() {
  Words columns;
  for (int i = 1; i <= 6; ++i)
    for (int j = i; j <= 6; ++j)
      columns.push_back(fmt::format("c{}{}_{}", i, j, j <= 3 ? "um2" : i <= 3 ? "um_mrad" : "mrad2"));
  return columns;
}

}  // namespace

const Words& pose_columns() {
  static const Words columns{"x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz"};
  return columns;
}

Words axis_columns(const machine::MachineDescription& machine) {
  const auto mechanism = machine.make_mechanism();
  Words columns;
  for (int i = 0; i < mechanism->axis_count(); ++i)
    columns.push_back(mechanism->axis_name(i) + (mechanism->axis_is_angle(i) ? "_deg" : "_mm"));
  return columns;
}

const Words& approach_columns() {
  static const Words columns{"a1", "a2", "a3", "a4", "a5", "a6"};
  return columns;
}

const Words& frame_columns() {
  static const Words columns{"frame_um", "frame_mrad", "frame_permille"};
  return columns;
}

const Words& noise_columns(NoiseColumns kind) {
  static const Words none, isotropic{"sigma_um", "sigma_mrad"},
      axes{"sx_um", "sy_um", "sz_um", "srx_mrad", "sry_mrad", "srz_mrad"}, full = covariance_columns();
  switch (kind) {
    case NoiseColumns::isotropic:
      return isotropic;
    case NoiseColumns::axes:
      return axes;
    case NoiseColumns::full:
      return full;
    case NoiseColumns::none:
      break;
  }
  return none;
}

double noise_unit(const std::string& column) {
  constexpr double kMilliradian = 1e-3;
  if (column.ends_with("_um2")) return kMicrometre * kMicrometre;
  if (column.ends_with("_um_mrad")) return kMicrometre * kMilliradian;
  if (column.ends_with("_mrad2")) return kMilliradian * kMilliradian;
  return column.ends_with("_um") ? kMicrometre : kMilliradian;
}

TableColumns check_columns(const Words& header, const machine::MachineDescription& machine,
                           const std::string& file, int line) {
  const Place place{file, line, 0};
  Words required = pose_columns();
  std::ranges::copy(axis_columns(machine), std::back_inserter(required));
  Words known = required;
  std::ranges::copy(approach_columns(), std::back_inserter(known));
  std::ranges::copy(frame_columns(), std::back_inserter(known));
  const auto kinds = {NoiseColumns::isotropic, NoiseColumns::axes, NoiseColumns::full};
  for (const NoiseColumns kind : kinds) std::ranges::copy(noise_columns(kind), std::back_inserter(known));

  check_header_words(header, known, place);
  if (const Words absent = missing(required, header); !absent.empty())
    throw InputError(place, fmt::format("missing column{} {} (machine {})", absent.size() > 1 ? "s" : "",
                                        fmt::join(absent, ", "), machine.name));
  TableColumns columns;
  for (const NoiseColumns kind : kinds) {
    const Words& words = noise_columns(kind);
    const Words absent = missing(words, header);
    if (absent.size() == words.size()) continue;
    if (!absent.empty())
      throw InputError(place, fmt::format("the noise is told in part: missing {}", fmt::join(absent, ", ")));
    if (columns.noise != NoiseColumns::none)
      throw InputError(place, fmt::format("the noise is told twice, by {} and by {}",
                                          noise_columns(columns.noise).front(), words.front()));
    columns.noise = kind;
  }
  const Words absent_frame = missing(frame_columns(), header);
  columns.frame = absent_frame.empty();
  if (!absent_frame.empty() && absent_frame.size() < frame_columns().size())
    throw InputError(
        place, fmt::format("the measuring frame is told in part: missing {}", fmt::join(absent_frame, ", ")));
  const Words sides = missing(approach_columns(), header);
  columns.approach = sides.empty();
  if (!sides.empty() && sides.size() < approach_columns().size())
    throw InputError(place, fmt::format("approaches are told in part: missing {}", fmt::join(sides, ", ")));
  if (columns.approach && machine.is_chain())
    throw InputError(place, "approaches a1..a6 are those of a hexapod's struts");
  return columns;
}

}  // namespace understudy::calibration
