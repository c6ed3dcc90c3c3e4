#include "studies/gap/sample_gaps.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/random.h"
#include "core/units.h"
#include "sim/as_built/as_built_file.h"
#include "sim/as_built/truth.h"
#include "sim/sensors/microscope.h"

namespace understudy::studies {
namespace {

constexpr double kZeroMax = 0.2e-3;  // [m], that the commanded heights are below the gaps, at most
constexpr double kHeightMin = 0.02e-3, kHeightMax = 5e-3;  // [m]

struct Tilt {
  double angle = 0, azimuth = 0;  ///< [rad], of the flat's normal from the tool axis, and whither
};

void check(const SampleGapsRequest& request, const machine::MachineDescription& machine) {
  if (!machine.has_microscope)
    throw InputError({machine.file.string(), 0, 0}, "has no laser and microscope: there is no gap sensor");
  if (request.heights.empty()) throw InputError("--heights: at least one is needed");
  for (const double height : request.heights)
    if (!(height >= kHeightMin && height <= kHeightMax))
      throw InputError(fmt::format("--heights {:g} is outside {:g} to {:g} mm", to_mm(height),
                                   to_mm(kHeightMin), to_mm(kHeightMax)));
}

std::vector<Tilt> tilts(double wedge) {
  if (!(wedge > 0)) return {{}};
  return {{}, {wedge, 0}, {wedge, from_deg(90)}};
}

/// As calibration::Flat::slope.
Vec2 tilt_slope(const Tilt& tilt) {
  return -std::tan(tilt.angle) * Vec2(std::cos(tilt.azimuth), std::sin(tilt.azimuth));
}

/// The tip, at a gap along the tool axis from the middle of the table.
Pose tool_over(const Tilt& tilt, double gap) {
  const Vec3 normal_T(std::sin(tilt.angle) * std::cos(tilt.azimuth),
                      std::sin(tilt.angle) * std::sin(tilt.azimuth), std::cos(tilt.angle));
  const Quat turn = shortest_arc_from_z(normal_T).conjugate();
  return make_pose(turn, Vec3(gap * (turn * Vec3::UnitZ())));
}

}  // namespace

SampledGaps sample_gaps(const SampleGapsRequest& request, const machine::MachineDescription& machine,
                        const std::function<void(const std::string& name, const Image& picture)>& keep) {
  check(request, machine);
  SampledGaps sample;
  const sim::AsBuilt built = sim::make_as_built(machine, request.as_built, request.seed);
  const machine::MachineDescription truth = sim::true_description(machine, built);
  sample.as_built = sim::write_as_built(built);
  sim::MicroscopeOptions options;
  options.speckle = request.speckle;
  sim::Microscope microscope(truth, nullptr, request.seed, options);
  const Camera& camera = truth.microscope.camera;
  const Region sensor = camera.sensor();
  Random random(request.seed, "heights over flats");
  sample.table = "height_mm,height_sigma_um,picture,gap_mm,gap_sigma_um,tilt_deg,azimuth_deg\n";
  sample.truth = "picture,gap_mm\n";
  for (const Tilt& tilt : tilts(request.wedge)) {
    const auto number = static_cast<int>(sample.rows.slopes.size());
    sample.rows.slopes.push_back(tilt_slope(tilt));
    const double zero = random.uniform(0, kZeroMax);
    const std::string flat = fmt::format("{:g},{:g}", to_deg(tilt.angle), to_deg(tilt.azimuth));
    const double touched = request.feeler + request.feeler_sigma * random.normal() - zero;
    sample.rows.known.push_back({number, touched, request.feeler, request.feeler_sigma});
    sample.table += fmt::format("{:.6f},,,{:g},{:g},{}\n", to_mm(touched), to_mm(request.feeler),
                                to_um(request.feeler_sigma), flat);
    for (const double height : request.heights) {
      stop_if_interrupted();
      const double gap = height + zero + request.height_sigma * random.normal();
      const std::string name = fmt::format("dot-{:03}.png", ++sample.pictures);
      keep(name,
           microscope.expose(tool_over(tilt, gap), sensor, static_cast<std::uint64_t>(sample.pictures)));
      sample.rows.rows.push_back({0, number, height, request.height_sigma, name, ""});
      sample.table +=
          fmt::format("{:.6f},{:g},{},,,{}\n", to_mm(height), to_um(request.height_sigma), name, flat);
      sample.truth += fmt::format("{},{:.6f}\n", name, to_mm(gap));
    }
  }
  return sample;
}

}  // namespace understudy::studies
