#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>

#include <fmt/format.h>

#include "cli/plan/machine_reach.h"
#include "cli/plan/plan_options.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/error_context.h"
#include "core/units.h"
#include "geometry/box_mesh.h"
#include "geometry/printed_clearance.h"
#include "machine/fixture_file.h"
#include "toolpath/lattice/lattice_fill.h"
#include "toolpath/lattice/lattice_json.h"
#include "toolpath/lattice/lattice_planner.h"
#include "toolpath/lattice/strut_range.h"

namespace understudy::cli {
namespace {

struct LatticeRequest {
  PlanOptions options;
  std::string part, place = "0,0,0", directions = "free";
  double strut_mm = 5, scale = 1, diameter_mm = 0.48, dwell_s = 3, margin_mm = 0.1, tilt_max_deg = 90,
         turn_deg = 0, time_limit_s = 600, joint_press_mm = to_mm(-geometry::contact_with_printed(true));
  bool force = false, ignore_reach = false;
};

void check(const LatticeRequest& r) {
  check_options(r.options);
  check_option("--scale", r.scale, 1000);
  check_option("--diameter", r.diameter_mm, 20);
  check_option("--margin", r.margin_mm, 10);
  if (!(r.joint_press_mm >= 0 && r.joint_press_mm <= 10))
    throw InputError(fmt::format("--joint-press {:g} is outside 0..10", r.joint_press_mm));
  check_option("--time-limit", r.time_limit_s, 86400);
  if (r.turn_deg != 0 && r.directions != "five") throw InputError("--turn needs --directions five");
  if (!(std::abs(r.turn_deg) <= 360))
    throw InputError(fmt::format("--turn {:g} is outside -360..360", r.turn_deg));
  if (!(r.tilt_max_deg >= 0 && r.tilt_max_deg <= 90))
    throw InputError(fmt::format("--tilt {:g} is outside 0..90", r.tilt_max_deg));
}

/// box:20x20x15
Vec3 box_size(const std::string& text) {
  Vec3 size;
  const char* at = text.c_str() + std::string("box:").size();
  for (int k = 0; k < 3; ++k) {
    char* end = nullptr;
    size[k] = from_mm(std::strtod(at, &end));
    if (end == at || *end != (k < 2 ? 'x' : '\0'))
      throw InputError(fmt::format("'{}' is not a box of three sides in mm, like box:20x20x15", text));
    at = end + 1;
  }
  return size;
}

/// On z = 0, centred in x and y.
std::shared_ptr<const geometry::Mesh> standing_box(const Vec3& size) {
  const Vec3 half(size.x() / 2, size.y() / 2, 0);
  return geometry::box_mesh(-half, size - half);
}

bool is_frame(const LatticeRequest& r) { return std::filesystem::path(r.part).extension() == ".json"; }

toolpath::Lattice lattice_of(const LatticeRequest& r) {
  if (is_frame(r)) return toolpath::read_lattice(r.part);
  const double strut = from_mm(r.strut_mm);
  const auto fill = r.part.starts_with("box:")
                        ? toolpath::fill_box(box_size(r.part), strut)
                        : toolpath::fill_part(*geometry::read_stl(machine::find_fixture(r.part)), strut);
  if (fill.dropped > 0)
    fmt::print(stderr, "warning: {} nodes within the part have no struts to the table and were left out\n",
               fill.dropped);
  return fill.lattice;
}

void warn_of_lengths(const toolpath::Lattice& lattice) {
  std::size_t outside = 0;
  double longest = 0;
  for (std::size_t s = 0; s < lattice.struts.size(); ++s) {
    const double length = lattice.length(s);
    outside +=
        length < toolpath::kShortestStrut - kMicrometre || length > toolpath::kLongestStrut + kMicrometre;
    longest = std::max(longest, length);
  }
  if (outside > 0)
    fmt::print(stderr,
               "warning: {} of {} struts are outside {:g}..{:g} mm (Ishak 2018), the longest {:.1f} mm\n",
               outside, lattice.struts.size(), to_mm(toolpath::kShortestStrut),
               to_mm(toolpath::kLongestStrut), to_mm(longest));
}

/// True from `seconds` on.
std::function<bool()> deadline(double seconds) {
  const auto end =
      std::chrono::steady_clock::now() +
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(seconds));
  return [end] { return std::chrono::steady_clock::now() > end; };
}

toolpath::LatticePlan plan_of(const LatticeRequest& r, const machine::MachineDescription& machine) {
  toolpath::LatticePlan plan;
  plan.limits.tool = machine.tool.bodies;
  plan.limits.nozzle_flat = machine.tool.flat_diameter;
  plan.limits.strut_diameter = from_mm(r.diameter_mm);
  plan.limits.ground_gap = machine.gap.aim;
  plan.limits.margin = from_mm(r.margin_mm);
  // Where the nozzle's flat still overlaps a strut that leaves the node across the tool's axis.
  plan.limits.joint = 0.5 * machine.tool.flat_diameter + plan.limits.strut_diameter + plan.limits.margin;
  plan.limits.joint_press = from_mm(r.joint_press_mm);
  plan.limits.lift = from_mm(r.options.clearance_mm);
  plan.limits.tilt_max = from_deg(r.tilt_max_deg);
  if (!r.ignore_reach) plan.limits.way = machine_reach(machine);
  plan.limits.accept_interference = r.force;
  plan.limits.out_of_time = deadline(r.time_limit_s);
  plan.feed = from_mm(r.options.feed_mm_per_s);
  plan.approach_feed = from_mm(r.options.approach_mm_per_s);
  plan.approach = machine.gap.standoff;
  plan.dwell = r.dwell_s;
  plan.filament_diameter = machine.tool.filament_diameter;
  plan.temperature = r.options.temperature_c + kCelsiusZero;
  plan.fan = r.options.fan;
  return plan;
}

// Ishak 2018: the part's own cubes, printed upwards and from four sides.
int plan_five_directions(const LatticeRequest& r) {
  if (is_frame(r)) throw InputError("--directions five needs a part, " + r.part + " is a frame");
  const auto machine = printing_machine(r.options.machine);
  auto plan = plan_of(r, machine);
  const double strut = from_mm(r.strut_mm) * r.scale;
  const auto ranges = toolpath::strut_ranges(toolpath::ToolEnvelope(plan.limits.tool),
                                             plan.limits.strut_diameter, plan.limits.margin);
  if (!toolpath::in_ranges(strut, ranges))
    throw InputError(fmt::format("a strut of {:g} mm is outside {}, for which the nozzle of {} leaves room",
                                 to_mm(strut), toolpath::to_string(ranges), machine.name));
  const auto part = r.part.starts_with("box:") ? standing_box(box_size(r.part))
                                               : geometry::read_stl(machine::find_fixture(r.part));
  const auto segmented = toolpath::segment_part(*part, from_mm(r.strut_mm));
  auto segments = toolpath::segment_lattice(segmented);
  toolpath::turn(segments, from_deg(r.turn_deg));
  toolpath::place_lattice(segments.lattice, r.scale,
                          place_from("--place", r.place) + from_mm(0.5 * r.diameter_mm) * Vec3::UnitZ());
  const auto result = with_progress(!r.options.quiet, [&](const Progress& progress) {
    plan.limits.progress = progress;
    return toolpath::plan_segments(segments, plan);
  });
  write_program(result.program, machine, r.options);
  print_written(
      r.options,
      fmt::format("{} struts, {:.1f} mm; the cubes take {:.0f} % of the part; struts of {} can be printed",
                  segments.lattice.struts.size(), to_mm(result.printed), 100 * segmented.share,
                  toolpath::to_string(ranges)));
  for (const auto& segment : segments.segments)
    if (!r.options.quiet)
      fmt::print("  {}: {} struts\n", toolpath::name_of(segment.direction), segment.struts.size());
  return kGood;
}

int plan_lattice(const LatticeRequest& r) {
  check(r);
  if (r.directions == "five") return plan_five_directions(r);
  const auto machine = printing_machine(r.options.machine);
  toolpath::Lattice lattice = lattice_of(r);
  const Vec3 place = place_from("--place", r.place);
  // Struts on the table rest on it: their middle is half a diameter above.
  toolpath::place_lattice(lattice, r.scale, place + from_mm(0.5 * r.diameter_mm) * Vec3::UnitZ());
  auto plan = plan_of(r, machine);
  const auto result = with_progress(!r.options.quiet, [&](const Progress& progress) {
    plan.limits.progress = progress;
    return in_context_of(is_frame(r) ? r.part : "", [&] { return toolpath::plan_lattice(lattice, plan); });
  });
  warn_of_lengths(lattice);
  for (const std::string& warning : result.sequence.warnings) fmt::print(stderr, "warning: {}\n", warning);
  write_program(result.program, machine, r.options, result.sequence.warnings);
  const auto tilted = std::count_if(result.sequence.prints.begin(), result.sequence.prints.end(),
                                    [](const toolpath::StrutPrint& p) { return p.axis.z() < 1 - 1e-9; });
  print_written(r.options, fmt::format("{} struts, {:.1f} mm, {} with the tool tilted", lattice.struts.size(),
                                       to_mm(result.printed), tilted));
  return kGood;
}

}  // namespace

void add_plan_lattice(CLI::App& plan, Action& action) {
  auto request = std::make_shared<LatticeRequest>();
  request->options.machine = "arm";
  request->options.feed_mm_per_s = 1;  // Ishak 2018, as are the diameter and the fan
  request->options.approach_mm_per_s = 5;
  request->options.clearance_mm = 2;
  request->options.temperature_c = 210;
  request->options.fan = 1;
  auto* lattice = plan.add_subcommand("lattice", "Struts in the air, one by one, none run into");
  lattice
      ->add_option("part", request->part,
                   "a frame (.json), a part to fill with cubes (STL in mm or a name under models/parts), or "
                   "box:20x20x15")
      ->required();
  add_machine_option(*lattice, request->options);
  lattice
      ->add_option(
          "--directions", request->directions,
          "free: each strut with an axis that is clear; five: a base upwards and what protrudes from its "
          "four sides along Y-, Y+, X-, X+ (Ishak 2018)")
      ->check(CLI::IsMember({"free", "five"}))
      ->capture_default_str();
  lattice
      ->add_option("--strut", request->strut_mm,
                   "mm: side of the cubes that fill a part, 5..11; with five directions what the nozzle "
                   "leaves room for")
      ->capture_default_str();
  lattice->add_option("--scale", request->scale, "of the lattice")->capture_default_str();
  lattice->add_option("--place", request->place, "X,Y,Z mm: the middle of its lower side stands there")
      ->capture_default_str();
  lattice->add_option("--turn", request->turn_deg, "degrees about Z, of a part in five directions")
      ->capture_default_str();
  lattice->add_option("--diameter", request->diameter_mm, "mm, of a strut")->capture_default_str();
  lattice->add_option("--dwell", request->dwell_s, "s at the end of each strut, for it to solidify")
      ->capture_default_str();
  lattice->add_option("--margin", request->margin_mm, "mm between tool and struts, at least")
      ->capture_default_str();
  lattice->add_option("--tilt", request->tilt_max_deg, "degrees from vertical that the tool may lean")
      ->capture_default_str();
  lattice
      ->add_option(
          "--joint-press", request->joint_press_mm,
          "mm that the nozzle may press into struts where they meet the one it prints; more than this "
          "is a contact in a rehearsal")
      ->capture_default_str();
  lattice
      ->add_option("--time-limit", request->time_limit_s,
                   "s that the search for an order may take; then no order is an error")
      ->capture_default_str();
  lattice->add_flag("--force", request->force,
                    "where no way is clear, take the clearest and warn, instead of refusing");
  lattice->add_flag("--ignore-reach", request->ignore_reach, "do not ask the machine whether it gets there");
  add_motion_options(*lattice, request->options);
  add_nozzle_options(*lattice, request->options);
  add_output_option(*lattice, request->options);
  lattice->callback([=, &action] { action = [=] { return plan_lattice(*request); }; });
}

}  // namespace understudy::cli
