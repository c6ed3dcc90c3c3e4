// Where machine descriptions lie.
#pragma once

#include <filesystem>
#include <string>

namespace understudy::machine {

/// The machine.yaml that a name or path means. Throws InputError naming the known machines.
std::filesystem::path find_model(const std::string& name_or_path);

/// The source tree's or the installed models, whatever $UNDERSTUDY_MODELS says.
std::filesystem::path shipped_models_folder();

}  // namespace understudy::machine
