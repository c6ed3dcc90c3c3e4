// Does this installation work? Each part is tried, not looked up.
#pragma once

#include <string>
#include <vector>

namespace understudy::cli {

struct HealthCheck {
  std::string name;
  bool ok = false;
  std::string detail;
};

/// Loads the models, steps the plant, renders a frame. Never throws: a failure is an entry.
std::vector<HealthCheck> self_test();

}  // namespace understudy::cli
