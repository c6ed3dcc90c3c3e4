// Where the files of machines and materials lie, and which keys they have.
#pragma once

#include <filesystem>
#include <string>

#include "core/yaml/map_schema.h"

namespace understudy::machine {

/// The machine.yaml that a name or path means. Throws InputError naming the known machines.
std::filesystem::path find_model(const std::string& name_or_path);

/// Throws InputError where load_machine() would refuse a file of this name and text.
void check_machine_text(const std::string& text, const std::filesystem::path& file);

/// The source tree's or the installed models, whatever $UNDERSTUDY_MODELS says.
std::filesystem::path shipped_models_folder();

/// The keys of a machine.yaml, as load_machine() asks for them.
MapSchema machine_schema();

/// The keys of a material file, as load_material() asks for them.
MapSchema material_schema();

}  // namespace understudy::machine
