#include "cli/doctor.h"

#include <exception>

#include <fmt/format.h>

#include "core/version.h"
#include "machine/description.h"

namespace understudy::cli {
namespace {

std::string try_models() {
  const auto names = machine::machine_names();
  for (const auto& name : names) machine::load_machine(name);
  return fmt::format("{} machines in {}", names.size(), machine::models_folder().string());
}

}  // namespace

HealthCheck attempt(const std::string& name, const std::function<std::string()>& what) {
  try {
    return {name, true, what()};
  } catch (const std::exception& e) {
    return {name, false, e.what()};
  }
}

std::vector<HealthCheck> self_test() {
  std::vector<HealthCheck> checks{{"understudy", true, kVersion}, attempt("models", try_models)};
  for (const HealthCheck& check : twin_self_test()) checks.push_back(check);
  return checks;
}

}  // namespace understudy::cli
