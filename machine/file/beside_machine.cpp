#include "machine/file/beside_machine.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "core/yaml/yaml_map.h"

namespace understudy::machine {
namespace fs = std::filesystem;

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

std::optional<StagedFile> staged_urdf(const fs::path& original, const fs::path& path) {
  const std::string urdf = urdf_named_in(read_file(original), original);
  if (urdf.empty() || fs::path(urdf).is_absolute()) return std::nullopt;
  const fs::path from = fs::absolute(original).parent_path() / urdf,
                 to = fs::absolute(path).parent_path() / urdf;
  std::error_code error;
  if (fs::equivalent(from, to, error)) return std::nullopt;
  const std::string content = read_file(from);
  if (fs::exists(to)) {
    if (read_file(to) == content) return std::nullopt;
    throw InputError(fmt::format("{} is not the URDF of {}: write the machine to another folder", to.string(),
                                 original.string()));
  }
  check_writable(to);
  return std::optional<StagedFile>(std::in_place, to, content);
}

}  // namespace understudy::machine
