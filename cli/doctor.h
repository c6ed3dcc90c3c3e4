// Does this installation work? Each part is tried, not looked up.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/library_versions.h"

namespace understudy::cli {

struct HealthCheck {
  std::string name;
  bool ok = false;
  std::string detail;
};

/// Loads the models, steps the plant, renders a frame. Never throws: a failure is an entry.
std::vector<HealthCheck> self_test();

/// The part of it that needs the twin; says so where the build is without it.
std::vector<HealthCheck> twin_self_test();

/// Of this program, whatever command runs.
LibraryVersions library_versions_in_use();

/// Those of them that commands other than the reading of the command line use.
LibraryVersions library_versions_of_rooms();

/// What `what` returns, or the message of what it throws.
HealthCheck attempt(const std::string& name, const std::function<std::string()>& what);

}  // namespace understudy::cli
