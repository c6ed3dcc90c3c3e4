// A section that a calibration writes into a machine file.
#pragma once

#include <filesystem>
#include <string>

namespace understudy::machine {

/// In double quotes, as YAML and JSON have it.
std::string quoted_text(const std::string& word);

/// The text of a machine file with one section replaced, or added at its end. `section` begins with its key
/// in a line of its own. All else, comments too, stays as it is.
std::string with_section(const std::string& text, const std::string& section);

/// Writes the machine file at `path`: `original` with the section. It appears under its name only when it can
/// be read back. Throws InputError where it cannot be written, or breaks a limit of the machine.
void write_with_section(const std::filesystem::path& original, const std::string& section,
                        const std::filesystem::path& path);

}  // namespace understudy::machine
