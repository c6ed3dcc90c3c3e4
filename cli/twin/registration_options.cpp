#include "cli/twin/registration_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "control/registration/pattern.h"

namespace understudy::cli {
namespace {

std::string triple(const std::array<double, 3>& values, const char* format) {
  return fmt::format("{}, {}, {}", fmt::format(fmt::runtime(format), values[0]),
                     fmt::format(fmt::runtime(format), values[1]),
                     fmt::format(fmt::runtime(format), values[2]));
}

}  // namespace

void add_registration_options(CLI::App& command, rehearsal::RegistrationRequest& request) {
  command
      .add_option("--pattern", request.pattern,
                  "CSV x_mm,y_mm,z_mm of six or more points on the drawn part; without it places are chosen")
      ->group("Finding the part");
  command.add_option("--places", request.places, "number of places to choose")
      ->check(CLI::Range(control::kPlacesMin, control::kPlacesMax))
      ->capture_default_str()
      ->group("Finding the part");
}

void print_registration(const rehearsal::RegistrationFigures& figures) {
  fmt::print("  registration: {} places measured", figures.places);
  if (figures.left_out > 0) fmt::print(", {} left out", figures.left_out);
  fmt::print(", {:.0f} s\n", figures.duration_s);
  for (const auto& row : figures.rows)
    if (!row.why.empty()) fmt::print("    left out: ({}) mm: {}\n", triple(row.place_mm, "{:.1f}"), row.why);
  if (!figures.fit) return;
  fmt::print("    part shifted by ({}) um, 1 sigma ({}), at ({}) mm\n", triple(figures.shift_um, "{:.0f}"),
             triple(figures.shift_sigma_um, "{:.0f}"), triple(figures.reference_mm, "{:.1f}"));
  fmt::print("    and turned by ({}) mrad, 1 sigma ({})\n", triple(figures.turn_mrad, "{:.2f}"),
             triple(figures.turn_sigma_mrad, "{:.2f}"));
  for (const std::string& freedom : figures.unseen) fmt::print("    not seen, left as drawn: {}\n", freedom);
  fmt::print("    chi-square {:.1f} for {} degrees of freedom, at most {:.1f} for this part\n",
             figures.chi_square, figures.degrees_of_freedom, figures.chi_square_limit);
  fmt::print("    surface found within {:.0f} um (1 sigma, at the worst place)", figures.normal_sigma_max_um);
  if (figures.normal_error_rms_um)
    fmt::print("; truly off by {:.0f} um RMS, {:.0f} um at most", *figures.normal_error_rms_um,
               figures.normal_error_max_um);
  fmt::print("\n");
}

}  // namespace understudy::cli
