#include "machine/file/section_text.h"

#include <cctype>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/error_context.h"
#include "core/file/output_file.h"
#include "machine/file/beside_machine.h"
#include "machine/model_files.h"

namespace understudy::machine {
namespace {

bool begins_top_level(const std::string& line) {
  return !line.empty() && !std::isspace(static_cast<unsigned char>(line[0]));
}

}  // namespace

std::string quoted_text(const std::string& word) {
  std::string out = "\"";
  for (const char c : word) {
    if (c == '"' || c == '\\') out += '\\';
    out += std::iscntrl(static_cast<unsigned char>(c)) ? '?' : c;
  }
  return out + "\"";
}

std::string with_section(const std::string& text, const std::string& section) {
  const std::string key = section.substr(0, section.find('\n'));
  std::istringstream in(text);
  std::string out, line;
  bool inside = false;
  while (std::getline(in, line)) {
    if (line.starts_with(key)) {
      inside = true;
      continue;
    }
    if (inside && begins_top_level(line)) inside = false;
    if (!inside) out += line + "\n";
  }
  while (out.ends_with("\n\n")) out.pop_back();
  return out + "\n" + section;
}

void check_machine_output(const std::filesystem::path& path) {
  if (path.extension() != ".yaml")
    throw InputError(fmt::format("{}: a machine file ends in .yaml", path.string()));
  check_writable(path);
}

StagedFile staged_with_section(const std::filesystem::path& original, const std::string& section,
                               const std::filesystem::path& path) {
  check_machine_output(path);
  const std::string text = with_section(machine_file_text(original), section);
  try {
    // A URDF is read where it lies: beside `path` it may be still to come (beside_machine.h).
    const bool urdf = !urdf_named_in(text, original).empty();
    check_machine_text(text, std::filesystem::absolute(urdf ? original : path));
  } catch (const InputError& error) {
    // Its place is a line of a file that is never written.
    throw InputError(Place{path.string()}, fmt::format("the calibrated machine would be refused: {}",
                                                       message_without_place(error)));
  }
  return StagedFile(path, text);
}

void write_with_section(const std::filesystem::path& original, const std::string& section,
                        const std::filesystem::path& path) {
  staged_with_section(original, section, path).commit();
}

}  // namespace understudy::machine
