// The URDF that a machine file names, where the file is written to another folder.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/file/staged_file.h"

namespace understudy::machine {

/// The bytes of a machine file, with the changes of `FILE{key: value}` in place. Throws InputError as
/// changed_text() does.
std::string machine_file_text(const std::filesystem::path& file);

/// `geometry.urdf` of the machine file's text; empty where it names none.
std::string urdf_named_in(const std::string& text, const std::filesystem::path& file);

/// The URDF of the machine file `original`, still to be given its place beside the machine file `path`;
/// nothing where none is named or it lies there already. Throws InputError where another file has that place.
std::optional<StagedFile> staged_urdf(const std::filesystem::path& original,
                                      const std::filesystem::path& path);

/// The same of the SRDF and the meshes of that URDF, each at its place below the folder of `path`; those that
/// lie outside the original's folder are left where they are.
std::vector<std::unique_ptr<StagedFile>> staged_companions(const std::filesystem::path& original,
                                                           const std::filesystem::path& path);

}  // namespace understudy::machine
