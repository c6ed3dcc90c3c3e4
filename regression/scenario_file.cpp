#include "regression/scenario_file.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include "control/registration/pattern.h"
#include "core/file/file_cache.h"
#include "core/file/read_file.h"
#include "core/yaml/changed_file.h"
#include "core/yaml/yaml_map.h"
#include "regression/expectation_keys.h"
#include "regression/golden_file.h"
#include "regression/scenario_faults.h"
#include "rehearsal/run_twin.h"

namespace understudy::regression {
namespace fs = std::filesystem;
namespace {

using namespace rehearsal;

const std::vector<std::string> kAsBuilt{"nominal", "sampled", "manufactured", "calibrated"};
const std::vector<std::string> kGapControls{"off", "start", "continuous"};
constexpr std::uint64_t kMachinesMax = 1'000'000;  // beyond it a range of seeds is a slip of the pen

bool is_path(const std::string& text, const std::string& extension) {
  return text.find('/') != std::string::npos || text.ends_with(extension);
}

fs::path existing_file(YamlMap& map, const std::string& key, const fs::path& folder, const char* about) {
  const std::string text = map.text(key, about);
  if (text.empty()) return {};
  const fs::path path = (folder / text).lexically_normal();
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored))
    map.fail(key, key + " " + path.string() + " does not exist or is not a file");
  return path;
}

std::string name_or_path(YamlMap& map, const std::string& key, const fs::path& folder,
                         const std::string& extension, const char* about) {
  const std::string text = map.text(key, about);
  if (!is_path(text, extension)) return text;
  const fs::path path = (folder / text).lexically_normal();
  std::error_code ignored;
  // A machine with another of its tools: hexapod.yaml+cutter.
  const fs::path file = path.string().substr(0, path.string().rfind('+'));
  if (!fs::exists(path, ignored) && !(key == "machine" && fs::exists(file, ignored)))
    map.fail(key, key + " " + path.string() + " does not exist");
  return path.string();
}

std::string read_fixture(YamlMap& map, const fs::path& folder) {
  const std::string name = name_or_path(map, "fixture", folder, ".stl",
                                        "part that is printed on: a name, an STL or a fixture file");
  return name.ends_with(".yaml") && !is_path(name, ".stl")
             ? name_or_path(map, "fixture", folder, ".yaml", "likewise")
             : name;
}

/// A word, or the path of an as-built file.
std::string read_as_built(YamlMap& map, const fs::path& folder) {
  const std::string text =
      name_or_path(map, "as_built", folder, ".yaml",
                   "nominal, sampled, manufactured, calibrated, or the path of an as-built file");
  if (!text.empty() && !is_path(text, ".yaml")) map.check_word("as_built", text, kAsBuilt);
  return text;
}

void read_seeds(YamlMap& map, MachineSeries& series) {
  const std::string text = map.text("seeds", "a range like 1-200");
  if (text.empty()) return;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, series.seed_first);
  const bool dash = first.ec == std::errc() && first.ptr != end && *first.ptr == '-';
  const auto last = dash ? std::from_chars(first.ptr + 1, end, series.seed_last) : first;
  if (!dash || last.ec != std::errc() || last.ptr != end)
    map.fail("seeds", "'seeds' of machines must be a range like 1-200, not '" + text + "'");
  if (series.seed_last < series.seed_first) map.fail("seeds", "seeds " + text + " run backwards");
  if (series.seed_last - series.seed_first >= kMachinesMax)
    map.fail("seeds", fmt::format("seeds {} are more than {} machines", text, kMachinesMax));
}

void read_tolerances(YamlMap& map, Scenario& scenario) {
  if (map.has("tip_tolerance_mm"))
    scenario.tip_tolerance_mm = map.number("tip_tolerance_mm", {0.001, 100},
                                           "a tip that is off by more is a no-go; else the machine's");
  if (map.has("orientation_tolerance_deg"))
    scenario.orientation_tolerance_deg =
        map.number("orientation_tolerance_deg", {0.001, 90},
                   "a tool turned away by more is a no-go; else the machine's");
}

/// How a robot's program is read.
void read_robot(YamlMap& map, RobotProgramRequest& robot) {
  if (map.has("signal")) {
    std::istringstream outputs(map.text("signal", "outputs that feed filament, joined by commas"));
    for (std::string output; std::getline(outputs, output, ',');) robot.signals.push_back(output);
  }
  if (map.has("bead_mm")) {
    const auto bead =
        map.numbers("bead_mm", 2, {0.01, 100}, "width and height of what a signal above 0 lays");
    if (bead[1] > bead[0] && !map.recording())
      map.fail("bead_mm", "bead_mm: a bead is no higher than it is wide");
    std::copy(bead.begin(), bead.end(), robot.bead_mm.begin());
  }
  if (map.has("flow_mm3_per_second"))
    robot.flow_mm3_per_s = map.number("flow_mm3_per_second", {1e-6, 1e9}, "mm3/s that a signal of 1 feeds");
  if (map.has("tool_points"))
    robot.tool_points = map.word("tool_points", {"x", "-x", "y", "-y", "z", "-z"},
                                 "axis of the program's tool that points out of its nozzle");
}

/// How lines of the program are read.
void read_dialect(YamlMap& map, const fs::path& folder, DialectRequest& dialect) {
  if (map.has("place_mm")) {
    const auto place = map.numbers("place_mm", 3, {}, "where the program's origin stands in W");
    std::copy(place.begin(), place.end(), dialect.place_mm.begin());
  }
  if (map.has("placement"))
    dialect.place_auto = map.word("placement", {"given", "auto"}, "auto: the place is found") == "auto";
  if (map.has("turn_deg"))
    dialect.turn_deg = map.number("turn_deg", {-360, 360}, "of the program about z through its origin");
  if (map.has("spin_deg"))
    dialect.spin_deg = map.number("spin_deg", {-360, 360}, "of the tool about its own axis");
  if (map.has("extruder_letter"))
    dialect.extruder_letter = map.word("extruder_letter", {"E", "A"}, "the word of the filament");
  if (map.has("ignored")) {
    std::istringstream words(map.text("ignored", "commands to pass over with their lines, joined by commas"));
    for (std::string word; std::getline(words, word, ',');) dialect.ignored.push_back(word);
  }
  if (map.has("macros"))
    dialect.macros =
        existing_file(map, "macros", folder, "path of a Klipper configuration with macros").string();
  if (map.has("temperature_c"))
    dialect.temperature_c = map.number("temperature_c", {100, 450}, "of the nozzle from the start on");
  if (map.has("nozzle_mm"))
    dialect.nozzle_mm =
        map.number("nozzle_mm", {0.05, 10}, "bore that is mounted, if not the machine file's");
  if (map.has("layer_mm"))
    dialect.layer_mm = map.number("layer_mm", {0.01, 10}, "of layers, where the path does not tell");
  const auto yes = [&map](const char* key, const char* about) {
    const std::string word = map.word(key, {"yes", "no", "true", "false"}, about);
    return word == "yes" || word == "true";
  };
  if (map.has("strict"))
    dialect.strict = yes("strict", "whether lines that cannot be read or made are refused");
  if (map.has("relative_extrusion"))
    dialect.relative_extrusion =
        yes("relative_extrusion", "whether E is relative from the start, as after M83");
  const auto sign = [&map](const char* key, const char* about) {
    return map.number(key, {}, about) < 0 ? -1 : 1;
  };
  if (map.has("b_sign")) dialect.b_sign = sign("b_sign", "1 or -1, sense of the word B");
  if (map.has("c_sign")) dialect.c_sign = sign("c_sign", "1 or -1, sense of the word C");
  if (map.has("coordinates"))
    dialect.coordinates =
        map.word("coordinates", {"tip", "machine", "crossing"}, "the point that X, Y and Z place");
  read_robot(map, dialect.robot);
}

void read_surface(YamlMap& map, const fs::path& folder, SurfaceRequest& surface) {
  if (map.has("intended"))
    surface.intended = name_or_path(map, "intended", folder, ".stl", "the part that the print should be");
  if (map.has("depth_of_cut_mm"))
    surface.depth_of_cut_mm = map.number("depth_of_cut_mm", {0.001, 100},
                                         "the stock that is milled is larger than 'intended' by this");
  if (map.has("stock"))
    surface.stock = name_or_path(map, "stock", folder, ".stl", "the stock that is milled to 'intended'");
  if (map.has("profile_mm"))
    surface.profile_mm = map.numbers("profile_mm", 6, {}, "ends of the profile: x, y, z, x, y, z");
  if (map.has("probe"))
    surface.probe = map.numbers("probe", 3, {}, "direction from which the surface is felt");
}

void read_registration(YamlMap& map, const fs::path& folder, RegistrationRequest& registration) {
  if (!map.has("register")) return;
  map.section("register", "the gap sensor finds the part before the print", [&](YamlMap& keys) {
    registration.wanted = true;
    if (keys.has("places"))
      registration.places = keys.integer("places", control::kPlacesMin, control::kPlacesMax,
                                         "number of places that are chosen");
    if (!keys.has("pattern")) return;
    registration.pattern =
        existing_file(keys, "pattern", folder, "CSV x_mm,y_mm,z_mm of points on the drawn part").string();
    if (keys.has("places") && !keys.recording())
      keys.fail("places", "places is for places that are chosen; the pattern has its own");
  });
}

void read_scenario(YamlMap& map, const fs::path& folder, Scenario& scenario) {
  scenario.name = map.text("name", "of the scenario, in reports");
  scenario.description = map.text("description", "what it shows");
  scenario.source = map.text("source", "where the case comes from");
  if (map.has("command")) {
    scenario.command = map.text("command", "of a study in place of a rehearsal: what follows `understudy`");
    scenario.expect = read_expectations(map, FiguresOf::command);
    return;
  }
  scenario.machine = name_or_path(map, "machine", folder, ".yaml", "name of a model, or a path");
  if (map.has("plan"))
    scenario.plan = map.text("plan", "in place of `program`: what follows `understudy plan`");
  if (map.has("program") || scenario.plan.empty())
    scenario.program = existing_file(map, "program", folder, "path of the G-code file");
  if (!scenario.program.empty() && !scenario.plan.empty() && !map.recording())
    map.fail("plan", "plan and program exclude each other: which is to be printed?");
  if (map.has("fixture")) scenario.fixture = read_fixture(map, folder);
  scenario.as_built = read_as_built(map, folder);
  scenario.seed = map.seed("seed", "of the built machine and of all noise");
  scenario.gap_control = map.word("gap_control", kGapControls, "whether the gap is measured");
  scenario.engine = map.word("engine", engine_names(), "the plant");
  if (map.has("material"))
    scenario.material =
        name_or_path(map, "material", folder, ".yaml", "a name or a path; else the machine's");
  read_tolerances(map, scenario);
  read_dialect(map, folder, scenario.dialect);
  read_surface(map, folder, scenario.surface);
  read_registration(map, folder, scenario.registration);
  if (map.has("part_pose")) {
    scenario.part_pose =
        existing_file(map, "part_pose", folder, "where `register` found the part, a path").string();
    if (map.has("register") && !map.recording())
      map.fail("part_pose", "part_pose and register exclude each other: is the part found, or to be found?");
  }
  scenario.faults = read_faults(map);
  scenario.camera_faults = read_camera_faults(map);
  scenario.expect = read_expectations(map, FiguresOf::run);
  if (!map.has("machines")) return;
  map.section("machines", "the same program on machines of many seeds", [&](YamlMap& machines) {
    MachineSeries& series = scenario.machines.emplace();
    read_seeds(machines, series);
    series.expect = read_expectations(machines, FiguresOf::machines);
  });
}

Scenario read_file_of(const fs::path& word) {
  const fs::path path = changed_file(word.string()).file;
  Scenario scenario;
  scenario.file = path;
  YamlMap::read_text(read_file(path), word.string(),
                     [&](YamlMap& map) { read_scenario(map, path.parent_path(), scenario); });
  const fs::path golden = golden_file_of(path);
  std::error_code ignored;
  if (fs::exists(golden, ignored))
    scenario.golden = load_golden(golden, scenario.command.empty() ? FiguresOf::run : FiguresOf::command);
  return scenario;
}

}  // namespace

Scenario load_scenario(const fs::path& word) {
  return *cached<Scenario>(word.string(), [&] { return read_file_of(word); });
}

MapSchema scenario_schema() {
  return YamlMap::schema([](YamlMap& map) {
    Scenario scenario;
    read_scenario(map, {}, scenario);
  });
}

std::vector<fs::path> find_scenarios(std::span<const fs::path> paths) {
  std::vector<fs::path> found;
  for (const fs::path& path : paths) {
    std::error_code error;
    if (!fs::exists(path, error))
      throw InputError("cannot read " + path.string() + ": no such file or folder");
    if (!fs::is_directory(path, error)) {
      found.push_back(path);
      continue;
    }
    std::vector<fs::path> inside;
    for (const auto& entry : fs::directory_iterator(path))
      if (entry.is_regular_file() && entry.path().extension() == ".yaml") inside.push_back(entry.path());
    if (inside.empty()) throw InputError("there is no scenario (*.yaml) in " + path.string());
    std::sort(inside.begin(), inside.end());
    found.insert(found.end(), inside.begin(), inside.end());
  }
  return found;
}

}  // namespace understudy::regression
