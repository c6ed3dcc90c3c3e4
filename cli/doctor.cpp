#include "cli/doctor.h"

#include <exception>

#include <fmt/format.h>
#include <CLI/Version.hpp>

#include "core/simd.h"
#include "core/version.h"
#include "machine/description.h"
#include "vision/formats/formats.h"

namespace understudy::cli {
namespace {

std::string try_models() {
  const auto names = machine::machine_names();
  for (const auto& name : names) machine::load_machine(name);
  return fmt::format("{} machines in {}", names.size(), machine::models_folder().string());
}

std::string try_formats() {
  static_cast<void>(vision::formats());
  return vision::formats_file().string();
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
  std::vector<HealthCheck> checks{{"understudy", true, kVersion},
                                  attempt("models", try_models),
                                  attempt("formats", try_formats),
                                  attempt("simd", [] { return std::string(word(simd())); })};
  for (const HealthCheck& check : twin_self_test()) checks.push_back(check);
  return checks;
}

LibraryVersions library_versions_in_use() {
  LibraryVersions all = library_versions_of_rooms();
  all["CLI11"] = CLI11_VERSION;
  return all;
}

}  // namespace understudy::cli
