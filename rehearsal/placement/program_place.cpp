#include "rehearsal/placement/program_place.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace understudy::rehearsal {

RehearsalRequest placed(RehearsalRequest request, const ProgramPlace& place) {
  DialectRequest& dialect = request.dialect;
  dialect.place_auto = false;
  dialect.place_mm = {place.x_mm, place.y_mm, place.z_mm};
  dialect.turn_deg = place.turn_deg;
  dialect.spin_deg = place.spin_deg;
  if (!place.home_axes.empty()) request.home_axes = place.home_axes;
  return request;
}

std::string place_words(const ProgramPlace& place) {
  std::string words = fmt::format("--place {},{},{}", place.x_mm, place.y_mm, place.z_mm);
  if (place.turn_deg != 0) words += fmt::format(" --turn {}", place.turn_deg);
  if (place.spin_deg != 0) words += fmt::format(" --spin {}", place.spin_deg);
  if (!place.home_axes.empty()) words += fmt::format(" --home-axes {:.6g}", fmt::join(place.home_axes, ","));
  return words;
}

}  // namespace understudy::rehearsal
