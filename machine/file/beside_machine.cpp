#include "machine/file/beside_machine.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/is_file.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "core/yaml/changed_file.h"
#include "core/yaml/yaml_map.h"
#include "machine/file/urdf_section.h"

namespace understudy::machine {
namespace fs = std::filesystem;

std::string machine_file_text(const fs::path& file) {
  const ChangedFile changed = changed_file(file.string());
  std::error_code ignored;
  if (changed.changes.empty() || fs::is_regular_file(file, ignored)) return read_file(file);
  return changed_text(read_file(changed.file), changed, changed.file);
}

std::string urdf_named_in(const std::string& text, const fs::path& file) {
  struct Seen {};  // the other keys are not of interest here
  std::string urdf;
  try {
    YamlMap::read_text(text, file.string(), [&](YamlMap& root) {
      if (!root.has("geometry.urdf")) throw Seen{};
      root.section("geometry", "the mechanism as drawn", [&](YamlMap& map) {
        urdf = map.text("urdf", "file with axes, ranges and masses, relative to this one");
        throw Seen{};
      });
    });
  } catch (const Seen&) {
    return urdf;
  }
  return urdf;
}

namespace {

/// Throws where another file has the place.
bool is_there(const fs::path& from, const fs::path& to, const fs::path& original) {
  if (!understudy::is_there(to)) return false;
  if (read_file(to) == read_file(from)) return true;
  throw InputError(fmt::format("{} is not that of {}: write the machine to another folder", to.string(),
                               original.string()));
}

}  // namespace

std::optional<StagedFile> staged_urdf(const fs::path& original, const fs::path& path) {
  const std::string urdf = urdf_named_in(machine_file_text(original), original);
  if (urdf.empty() || fs::path(urdf).is_absolute()) return std::nullopt;
  const fs::path from = fs::absolute(original).parent_path() / urdf,
                 to = fs::absolute(path).parent_path() / urdf;
  std::error_code error;
  if (fs::equivalent(from, to, error)) return std::nullopt;
  if (is_there(from, to, original)) return std::nullopt;
  check_writable(to);
  return std::optional<StagedFile>(std::in_place, to, read_file(from));
}

std::vector<std::unique_ptr<StagedFile>> staged_companions(const fs::path& original, const fs::path& path) {
  std::vector<std::unique_ptr<StagedFile>> staged;
  const fs::path folder = fs::absolute(original).parent_path(), place = fs::absolute(path).parent_path();
  std::error_code error;
  if (fs::equivalent(folder, place, error)) return staged;
  const std::vector<fs::path> files = files_named_in(machine_file_text(original), original);
  for (std::size_t i = 1; i < files.size(); ++i) {  // the first is the URDF
    const fs::path name = files[i].lexically_relative(folder);
    if (name.empty() || *name.begin() == "..") continue;
    if (is_there(files[i], place / name, original)) continue;
    fs::create_directories((place / name).parent_path(), error);
    check_writable(place / name);
    staged.push_back(std::make_unique<StagedFile>(place / name, read_file(files[i])));
  }
  return staged;
}

}  // namespace understudy::machine
