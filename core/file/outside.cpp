#include "core/file/outside.h"

#include <cstdlib>
#include <string_view>
#include <system_error>

namespace understudy {
namespace fs = std::filesystem;

bool may_be_named_from(const fs::path& folder, const fs::path& path) {
  const char* allowed = std::getenv(kAllowOutside);
  if (allowed && std::string_view(allowed) == "1") return true;
  std::error_code error;
  const fs::path home = fs::weakly_canonical(fs::absolute(folder / "."), error);
  const fs::path place = fs::weakly_canonical(fs::absolute(path), error).lexically_relative(home);
  return !error && !place.empty() && *place.begin() != "..";
}

}  // namespace understudy
