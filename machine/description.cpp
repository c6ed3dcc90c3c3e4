#include "machine/description.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/digest.h"
#include "core/file/file_cache.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "core/yaml/changed_file.h"
#include "core/yaml/yaml_map.h"
#include "kinematics/chain/chain_kind.h"
#include "machine/accepted_errors.h"
#include "machine/built_tolerances.h"
#include "machine/calibrated_parameters.h"
#include "machine/cure.h"
#include "machine/file/calibration_section.h"
#include "machine/file/chain_section.h"
#include "machine/file/control_section.h"
#include "machine/file/gap_sensor_section.h"
#include "machine/file/gcode_section.h"
#include "machine/file/hexapod_section.h"
#include "machine/file/optics_section.h"
#include "machine/file/tool_section.h"
#include "machine/load_encoders.h"
#include "machine/machine_notes.h"
#include "machine/model_files.h"

namespace understudy::machine {
namespace {

ToleranceSet read_tolerance_set(YamlMap& map, bool chain) {
  ToleranceSet set;
  if (chain) {
    set.axis_position = map.quantity("axis_position_mm", {0, 20},
                                     "each coordinate of a turning axis' point, and of the tool's mount");
    set.axis_direction =
        map.quantity("axis_direction_deg", {0, 5}, "tilt of an axis, about both directions across it");
    set.zero_length = map.quantity("zero_mm", {0, 20}, "zero of a sliding axis");
    set.zero_angle = map.quantity("zero_deg", {0, 5}, "zero of a turning axis");
    if (map.has("rod_length_mm"))
      set.rod_length = map.quantity("rod_length_mm", {0, 20}, "of a rod, where the tool hangs on rods");
  } else {
    set.joint_position = map.quantity("joint_position_mm", {0, 20}, "each coordinate of a joint");
    set.length_offset = map.quantity("length_offset_mm", {0, 20}, "of a strut");
  }
  return set;
}

void read_tolerances(YamlMap& map, bool chain, Tolerances& tolerances, BuiltTolerances& built) {
  map.section("manufactured", "before any calibration",
              [&](YamlMap& set) { tolerances.manufactured = read_tolerance_set(set, chain); });
  map.section("after_calibration", "left after a calibration",
              [&](YamlMap& set) { tolerances.after_calibration = read_tolerance_set(set, chain); });
  read_built_tolerances(map, built);
  if (!map.has("mounting")) return;
  map.section("mounting", "of laser and microscope about their drawing", [&](YamlMap& set) {
    MountingTolerances& mounting = tolerances.mounting.emplace();
    mounting.position = set.quantity("position_mm", {0, 5}, "each coordinate of each device");
    mounting.angle = set.quantity("angle_mrad", {0, 100}, "of each device about each of its own axes");
    mounting.scale = set.quantity("scale_percent", {0, 20}, "of the picture");
  });
}

void read_gap(YamlMap& map, GapLimits& gap) {
  constexpr Bounds kGap{0.001, 10};
  gap.accepted_min = map.quantity("accepted_min_mm", kGap, "smallest gap that is good");
  gap.accepted_max = map.quantity("accepted_max_mm", kGap, "largest gap at which a bead sticks");
  gap.aim = map.quantity("aim_mm", kGap, "gap that the controller makes");
  gap.standoff =
      map.quantity("standoff_mm", {0.01, 50}, "distance from the surface at which an approach begins");
  if (!map.complete()) return;
  if (gap.accepted_min >= gap.accepted_max)
    throw InputError(
        map.place("accepted_min_mm"),
        fmt::format("{} is {:g} mm, not below accepted_max_mm of {:g} mm", map.path("accepted_min_mm"),
                    to_mm(gap.accepted_min), to_mm(gap.accepted_max)));
  if (gap.aim <= gap.accepted_min || gap.aim >= gap.accepted_max)
    throw InputError(
        map.place("aim_mm"),
        fmt::format("{} is {:g} mm, not between {:g} and {:g} mm, the accepted gaps", map.path("aim_mm"),
                    to_mm(gap.aim), to_mm(gap.accepted_min), to_mm(gap.accepted_max)));
  if (gap.standoff <= gap.accepted_max)
    throw InputError(map.place("standoff_mm"),
                     fmt::format("{} is {:g} mm, not above accepted_max_mm of {:g} mm",
                                 map.path("standoff_mm"), to_mm(gap.standoff), to_mm(gap.accepted_max)));
}

void read_table(YamlMap& map, geometry::Shape& table) {
  const Vec3 size = map.vector("size_mm", {1, 5000}, "its top is z = 0 of W");
  table = {"table", geometry::Box{size}, make_pose(Quat::Identity(), Vec3(0, 0, -size.z() / 2))};
}

void read_motion(YamlMap& map, MachineDescription& machine) {
  machine.cycle_time = map.quantity("cycle_ms", {0.05, 100}, "period of the setpoints");
  machine.travel_velocity = map.quantity("travel_mm_per_s", {0.1, 5000}, "of the tip in G0");
  machine.orientation_velocity =
      map.quantity("orientation_deg_per_s", {0.1, 5000}, "limit of the tool's angular speed");
  machine.acceleration = map.quantity("acceleration_mm_per_s2", {1, 1e6}, "of the tip along the path");
}

std::vector<std::string> mechanism_words() {
  std::vector<std::string> words{kinematics::kHexapod};
  for (const kinematics::ChainKind& kind : kinematics::chain_kinds()) words.push_back(kind.name);
  return words;
}

/// A machine file: the description, and what only a twin needs.
struct MachineFile {
  MachineDescription description;
  CalibratedParameters calibrated;
  BuiltTolerances tolerances;
  std::optional<AcceptedErrors> accepted;
  std::optional<Cure> cure;
  MachineNotes notes;
  LoadEncoderCounts load_encoders;
};

/// The tool of section `tool`, or the one of that name in `tools`, in its place.
void read_tools(YamlMap& root, const std::string& wanted, MachineFile& file) {
  MachineDescription& m = file.description;
  std::vector<std::string> names;
  bool found = wanted.empty();
  if (root.has("tools"))
    root.list("tools", 0, "other tools that the machine can carry: MACHINE+NAME is the machine with it",
              [&](YamlMap& map, std::size_t) {
                Tool tool;
                std::optional<Cure> cure;
                std::optional<GapLimits> gap;
                const std::string name = map.name("name", "behind the machine's name and a +");
                if (!map.recording() && std::ranges::find(names, name) != names.end())
                  throw InputError(map.place("name"), fmt::format("two tools are named '{}'", name));
                names.push_back(name);
                read_tool(map, tool, cure);
                if (map.has("gap"))
                  map.section("gap", "between tip and surface; as section gap where it is left out",
                              [&](YamlMap& limits) { read_gap(limits, gap.emplace()); });
                if (name != wanted) return;
                found = true;
                m.tool = std::move(tool);
                file.cure = cure;
                if (gap) m.gap = *gap;
                if (cure) m.process.extruder_lag = 0;  // light has none
              });
  if (!found && !root.recording())
    throw InputError(root.place("tools"),
                     names.empty() ? fmt::format("machine {} has no other tools, so no '{}'", m.name, wanted)
                                   : fmt::format("machine {} has no tool '{}': it has {}", m.name, wanted,
                                                 fmt::join(names, ", ")));
  if (!wanted.empty()) m.name += "+" + wanted;
}

void read_machine(YamlMap& root, MachineFile& file, const std::string& wanted_tool = {}) {
  MachineDescription& m = file.description;
  m.name = root.name("name", "shown in reports");
  m.mechanism = root.word("mechanism", mechanism_words(), "what the machine is");
  root.require("mechanism");
  if (root.has("assumed")) {
    file.notes.assumed = root.texts("assumed", "groups of figures below that nobody measured");
    for (const std::string& word : file.notes.assumed) root.check_word("assumed", word, assumption_words());
  }
  const bool chain = m.mechanism != kinematics::kHexapod;
  if (chain) {
    read_chain(root, m, file.notes);
    read_gcode_section(root, m);
  } else {
    read_hexapod(root, m);
  }
  read_calibration(root, m, file.calibrated);
  root.section("tool", "what hangs at the tip", [&](YamlMap& map) { read_tool(map, m.tool, file.cure); });
  if (root.has("process"))
    root.section("process", "the filament between drive and part",
                 [&](YamlMap& map) { read_process(map, m.process); });
  m.has_microscope = !chain || root.has("laser") || root.has("microscope");
  if (m.has_microscope) {
    root.section("laser", "the beam whose dot measures the gap",
                 [&](YamlMap& map) { read_laser(map, m.laser); });
    root.section("microscope", "the camera that sees the dot",
                 [&](YamlMap& map) { read_microscope(map, m.microscope); });
  }
  read_gap_sensor(root, m);
  root.section("tolerances", "1 sigma of a built machine about this description",
               [&](YamlMap& map) { read_tolerances(map, chain, m.tolerances, file.tolerances); });
  // A tool without a nozzle lays nothing that a gap would matter to.
  if (!root.has("tool.end_mill_diameter_mm") || root.has("gap"))
    root.section("gap", "between tip and surface", [&](YamlMap& map) { read_gap(map, m.gap); });
  read_tools(root, wanted_tool, file);
  if (root.has("accuracy"))
    root.section("accuracy", "how far off a print may be",
                 [&](YamlMap& map) { read_accepted_errors(map, file.accepted.emplace()); });
  root.section("table", "what the work stands on", [&](YamlMap& map) { read_table(map, m.table); });
  root.section("motion", "speeds of the tip, and the cycle", [&](YamlMap& map) { read_motion(map, m); });
  read_control_section(root, m.control);
  read_load_encoders(root, file.load_encoders);
  if (!root.complete()) return;
  if (!chain) settle_home(root.place(m.calibration ? "calibration" : "geometry"), m);
  if (m.has_microscope) check_optics(root, m);
}

MachineFile read_text_of(const std::string& bytes, const std::filesystem::path& path,
                         const std::string& tool = {}) {
  MachineFile file;
  MachineDescription& machine = file.description;
  machine.file = path;
  const std::string told = (tool.empty() ? "" : "\n+" + tool) + changed_file(path.string()).braces();
  machine.sha256 = sha256_hex(bytes + told);
  YamlMap::read_text(bytes, path.string(), [&](YamlMap& root) { read_machine(root, file, tool); });
  return file;
}

/// "hexapod+cutter{gap.aim_mm: 0.15}": a machine with another of its tools, and changed values; a file of
/// such a name is itself.
MachineFile read_file_of(const std::string& name_or_path) {
  const ChangedFile changed = changed_file(name_or_path);
  const std::string& name = changed.file;
  const std::size_t plus = name.rfind('+');
  std::error_code ignored;
  const bool tool = plus != std::string::npos && name.find('/', plus) == std::string::npos &&
                    !std::filesystem::exists(name, ignored);
  const std::filesystem::path path = find_model(tool ? name.substr(0, plus) : name);
  return read_text_of(read_file(path), path.string() + changed.braces(), tool ? name.substr(plus + 1) : "");
}

std::shared_ptr<const MachineFile> file_of(const std::string& name_or_path) {
  return cached<MachineFile>(name_or_path, [&] { return read_file_of(name_or_path); });
}

}  // namespace

MachineDescription load_machine(const std::string& name_or_path) {
  return file_of(name_or_path)->description;
}

void check_machine_text(const std::string& text, const std::filesystem::path& file) {
  read_text_of(text, file);
}

MachineDescription load_machine(const std::string& name_or_path, CalibratedParameters& parameters) {
  const auto file = file_of(name_or_path);
  parameters = file->calibrated;
  return file->description;
}

BuiltTolerances load_built_tolerances(const std::string& name_or_path) {
  return file_of(name_or_path)->tolerances;
}

LoadEncoderCounts load_encoder_counts(const std::string& name_or_path) {
  return file_of(name_or_path)->load_encoders;
}

std::optional<Cure> load_cure(const std::string& name_or_path) { return file_of(name_or_path)->cure; }

MachineNotes load_machine_notes(const std::string& name_or_path) { return file_of(name_or_path)->notes; }

AcceptedErrors load_accepted_errors(const std::string& name_or_path) {
  const auto file = file_of(name_or_path);
  return file->accepted.value_or(default_accepted_errors(file->description.tool));
}

MapSchema machine_schema() {
  // Told once: every way through the reader is tried, which takes seconds.
  static const MapSchema schema = YamlMap::schema([](YamlMap& root) {
    MachineFile file;
    read_machine(root, file);
  });
  return schema;
}

}  // namespace understudy::machine
