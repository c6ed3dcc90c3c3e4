#include "rehearsal/request/input_digest.h"

#include <filesystem>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/digest.h"
#include "core/file/file_cache.h"
#include "core/file/is_file.h"
#include "core/version.h"
#include "core/yaml/changed_file.h"
#include "machine/description.h"
#include "machine/fixture_file.h"
#include "machine/material.h"
#include "toolpath/gcode/macros/gcode_macros.h"

namespace understudy::rehearsal {
namespace {

/// A line for each input: its length ahead of it, so that none can pass for two.
class Inputs {
 public:
  void word(std::string_view key, std::string_view value) {
    text_ += fmt::format("{} {} {}\n", key, value.size(), value);
  }
  /// Numbers as the shortest text that reads back as the same.
  template <typename... Values>
  void values(std::string_view key, const Values&... all) {
    std::string line;
    ((line += fmt::format("{} ", all)), ...);
    word(key, line);
  }
  void bytes_of(std::string_view key, const std::filesystem::path& path) {
    word(key, path.empty() ? "" : cached_sha256(path));
  }
  void machine(std::string_view key, const std::string& name) {
    word(key, name.empty() ? "" : machine::load_machine(name).sha256);
  }
  std::string sha256() const { return sha256_hex(text_); }

 private:
  std::string text_;
};

double number(const std::optional<double>& value) { return value ? *value : -1; }

void add_faults(const RehearsalRequest& request, Inputs& inputs) {
  for (const FaultRequest& fault : request.faults) {
    const sim::FaultEvent& e = fault.event;
    inputs.values("fault", to_string(e.kind), fault.axis, e.time, e.steps, e.duration, e.amount, fault.angle);
  }
  for (const CameraFaultRequest& fault : request.camera_faults) {
    const sim::CameraFaultEvent& e = fault.event;
    inputs.values("camera fault", to_string(e.kind), e.time, e.share, e.power, e.gap_offset, e.offset_px,
                  e.direction);
  }
}

void add_world(const RehearsalRequest& request, Inputs& inputs) {
  const ChangedFile as_built = changed_file(request.as_built);
  if (!as_built.changes.empty()) inputs.word("as-built's changes", as_built.braces());
  if (is_file(as_built.file))
    inputs.bytes_of("as-built file", as_built.file);
  else
    inputs.word("as-built", request.as_built);
  const sim::TruthSeeds seeds = request.truth_seeds.value_or(request.seed);
  for (const sim::TruthGroup group : sim::all_truth_groups())
    inputs.values("seed", sim::to_string(group), seeds[group]);
  add_faults(request, inputs);
}

}  // namespace

std::string inputs_sha256(const RehearsalRequest& request, const std::string& program_sha256) {
  Inputs inputs;
  inputs.word("version", kVersion);
  inputs.machine("machine", request.machine);
  inputs.machine("before", request.before);
  if (program_sha256.empty())
    inputs.bytes_of("program", request.program);
  else
    inputs.word("program", program_sha256);
  inputs.bytes_of("fixture", request.fixture.empty() ? "" : machine::find_fixture(request.fixture));
  inputs.bytes_of("fixture file", machine::fixture_file_of(request.fixture));
  const std::string material =
      request.material.empty() ? machine::load_machine(request.machine).process.material : request.material;
  inputs.bytes_of("material", material.empty() ? "" : machine::find_material(changed_file(material).file));
  if (const std::string changes = changed_file(material).braces(); !changes.empty())
    inputs.word("material's changes", changes);
  add_world(request, inputs);
  inputs.word("engine", request.engine);
  inputs.values("gap control", request.gap_control, request.compare_without_gap_control);
  inputs.values("tolerances", number(request.tip_tolerance_mm), number(request.orientation_tolerance_deg));
  inputs.values("longest program", request.max_time);
  const DialectRequest& dialect = request.dialect;
  inputs.values("dialect", dialect.place_mm, dialect.extruder_letter, dialect.b_sign, dialect.c_sign,
                dialect.coordinates);
  if (dialect.relative_extrusion) inputs.word("extrusion", "relative");
  for (const std::string& word : dialect.ignored) inputs.word("ignored", word);
  if (!dialect.macros.empty()) {
    const auto macros = toolpath::GcodeMacros::read(dialect.macros);
    for (const std::string& file : macros.files()) inputs.bytes_of("macros", file);
  }
  inputs.values("temperature", number(dialect.temperature_c));
  inputs.values("nozzle and layer", number(dialect.nozzle_mm), number(dialect.layer_mm));
  inputs.values("strict", dialect.strict);
  const RobotProgramRequest& robot = dialect.robot;
  for (const std::string& signal : robot.signals) inputs.word("signal", signal);
  inputs.values("robot", robot.bead_mm, number(robot.flow_mm3_per_s), robot.tool_points);
  inputs.values("placement", dialect.place_auto, dialect.turn_deg, dialect.spin_deg);
  inputs.values("home", request.home_axes);
  const SurfaceRequest& surface = request.surface;
  inputs.bytes_of("intended", surface.intended.empty() ? "" : machine::find_fixture(surface.intended));
  inputs.values("profile", surface.profile_mm, surface.probe);
  if (surface.depth_of_cut_mm) inputs.values("depth of cut", *surface.depth_of_cut_mm);
  if (!surface.stock.empty()) inputs.bytes_of("stock", machine::find_fixture(surface.stock));
  inputs.values("registration", request.registration.wanted, request.registration.places);
  inputs.bytes_of("pattern", request.registration.pattern);
  inputs.bytes_of("part pose", request.part_pose);
  return inputs.sha256();
}

}  // namespace understudy::rehearsal
