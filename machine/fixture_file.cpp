#include "machine/fixture_file.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "machine/description.h"

namespace understudy::machine {
namespace fs = std::filesystem;

std::string find_fixture(const std::string& fixture) {
  if (fs::is_regular_file(fixture)) return fixture;
  const fs::path parts = models_folder() / "parts";
  const fs::path named = parts / (fixture + ".stl");
  if (fs::is_regular_file(named)) return named.string();
  std::vector<std::string> known;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(parts, ignored))
    if (entry.path().extension() == ".stl") known.push_back(entry.path().stem().string());
  std::sort(known.begin(), known.end());
  throw InputError(
      fmt::format("no fixture {}: neither a file nor one of {}", fixture, fmt::join(known, ", ")));
}

}  // namespace understudy::machine
