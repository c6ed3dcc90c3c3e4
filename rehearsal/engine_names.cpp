// Apart from run_twin.cpp, so that a program that only reads scenarios links no engine.
#include "rehearsal/run_twin.h"

namespace understudy::rehearsal {

const std::vector<std::string>& engine_names() {
  static const std::vector<std::string> names{"mujoco", "bullet", "quasistatic"};
  return names;
}

}  // namespace understudy::rehearsal
