// A section that a calibration writes into a machine file.
#pragma once

#include <filesystem>
#include <string>

#include "core/file/staged_file.h"

namespace understudy::machine {

/// In double quotes, as YAML and JSON have it.
std::string quoted_text(const std::string& word);

/// The text of a machine file with one section replaced, or added at its end. `section` begins with its key
/// in a line of its own. All else, comments too, stays as it is.
std::string with_section(const std::string& text, const std::string& section);

/// The machine file at `path`, still to be given its name: `original` with the section. Throws InputError
/// where it could not be read back or would break a limit of the machine, MachineError where it cannot be
/// written.
StagedFile staged_with_section(const std::filesystem::path& original, const std::string& section,
                               const std::filesystem::path& path);
/// The same, under its name.
void write_with_section(const std::filesystem::path& original, const std::string& section,
                        const std::filesystem::path& path);

/// Throws InputError where write_with_section() could not write `path`: to be asked before the work.
void check_machine_output(const std::filesystem::path& path);

}  // namespace understudy::machine
