#include "machine/fixture_file.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/file/is_file.h"
#include "core/file/read_file.h"
#include "core/yaml/yaml_map.h"
#include "machine/description.h"

namespace understudy::machine {
namespace fs = std::filesystem;

namespace {

fs::path named_shape(const std::string& name) { return models_folder() / "parts" / (name + ".stl"); }

std::vector<std::string> known_names() {
  std::vector<std::string> known;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(models_folder() / "parts", ignored))
    if (entry.path().extension() == ".stl") known.push_back(entry.path().stem().string());
  std::sort(known.begin(), known.end());
  return known;
}

struct Fixture {
  std::string shape;
  BuiltTolerances tolerances;  ///< of the part, on top of what was there
};

void read_fixture_keys(YamlMap& map, const fs::path& folder, Fixture& fixture) {
  const std::string shape = map.text("shape", "its STL, coordinates in W: a path, or a name of models/parts");
  if (!shape.empty()) {
    const fs::path beside = (folder / shape).lexically_normal(), named = named_shape(shape);
    if (is_file(beside) && beside.extension() != ".yaml")
      fixture.shape = beside.string();
    else if (is_file(named))
      fixture.shape = named.string();
    else
      map.fail("shape", fmt::format("shape {} is neither a file nor one of {}", beside.string(),
                                    fmt::join(known_names(), ", ")));
  }
  if (map.has("source")) map.text("source", "where shape and tolerances come from");
  if (map.has("tolerances"))
    map.section("tolerances", "1 sigma of what is clamped, in place of the machine file's",
                [&](YamlMap& keys) { read_part_tolerances(keys, fixture.tolerances); });
}

Fixture read_fixture_file(const std::string& file, const BuiltTolerances& otherwise = {}) {
  Fixture fixture{"", otherwise};
  YamlMap::read_text(read_file(file), file,
                     [&](YamlMap& map) { read_fixture_keys(map, fs::path(file).parent_path(), fixture); });
  return fixture;
}

}  // namespace

std::string fixture_file_of(const std::string& fixture) {
  const fs::path path(fixture);
  return path.extension() == ".yaml" && is_file(path) ? fixture : "";
}

std::string find_fixture(const std::string& fixture) {
  if (const std::string file = fixture_file_of(fixture); !file.empty()) return read_fixture_file(file).shape;
  if (is_file(fixture)) return fixture;
  if (const fs::path named = named_shape(fixture); is_file(named)) return named.string();
  throw InputError(
      fmt::format("no fixture {}: neither a file nor one of {}", fixture, fmt::join(known_names(), ", ")));
}

BuiltTolerances load_built_tolerances(const std::string& machine, const std::string& fixture) {
  const BuiltTolerances stated = load_built_tolerances(machine);
  const std::string file = fixture_file_of(fixture);
  return file.empty() ? stated : read_fixture_file(file, stated).tolerances;
}

MapSchema fixture_schema() {
  return YamlMap::schema([](YamlMap& map) {
    Fixture fixture;
    read_fixture_keys(map, {}, fixture);
  });
}

void check_fixture_file(const std::string& file) { (void)read_fixture_file(file); }

}  // namespace understudy::machine
