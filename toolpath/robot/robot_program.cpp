#include "toolpath/robot/robot_program.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "toolpath/robot/statement_scanner.h"

namespace understudy::toolpath {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kProgramMax = 200'000'000;  // [bytes]; docs/limits.md

std::optional<RobotLanguage> by_ending(const fs::path& path) {
  const std::string ending = upper_case(path.extension().string());
  if (ending == ".SRC") return RobotLanguage::krl;
  for (const char* rapid : {".MOD", ".MODX", ".PRG", ".SYS"})
    if (ending == rapid) return RobotLanguage::rapid;
  return std::nullopt;
}

/// The first line that is no comment of any language here, upper case, without leading blanks.
std::string first_line(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  constexpr int kMostLines = 1000;
  for (int i = 0; i < kMostLines && !text.empty(); ++i) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
    if (!line.empty() && std::string_view(";!(%").find(line.front()) == std::string_view::npos)
      return upper_case(line.substr(0, 80));
  }
  return "";
}

/// Beside NAME.src: NAME.dat; empty where there is none.
std::string data_beside(const fs::path& path) {
  for (const char* ending : {".dat", ".DAT", ".Dat"}) {
    fs::path data = path;
    data.replace_extension(ending);
    std::error_code none;
    if (fs::is_regular_file(data, none)) return read_file(data);
  }
  return "";
}

}  // namespace

const char* to_string(RobotLanguage language) { return language == RobotLanguage::krl ? "KRL" : "RAPID"; }

bool has_robot_ending(const fs::path& path) { return by_ending(path).has_value(); }

std::optional<RobotLanguage> robot_language(const fs::path& path, std::string_view text) {
  if (const auto language = by_ending(path)) return language;
  const std::string line = first_line(text);
  for (const char* begin : {"&ACCESS", "&REL", "&PARAM", "&COMMENT", "DEF ", "GLOBAL DEF "})
    if (line.starts_with(begin)) return RobotLanguage::krl;
  if (line.starts_with("MODULE ")) return RobotLanguage::rapid;
  return std::nullopt;
}

Program read_robot_program(const fs::path& path, const std::string& text, const RobotOptions& options) {
  const auto language = robot_language(path, text);
  if (!language) throw InputError(path.string() + ": neither KRL (.src, DEF) nor RAPID (.mod, .prg, MODULE)");
  const std::string data = *language == RobotLanguage::krl ? data_beside(path) : "";
  if (text.size() + data.size() > kProgramMax)
    throw InputError(Place{path.string()},
                     fmt::format("larger than {} MB, as no program of a robot is", kProgramMax / 1'000'000));
  if (*language == RobotLanguage::rapid) return parse_rapid(text, path.string(), options);
  return parse_krl(text, data, path.string(), options);
}

}  // namespace understudy::toolpath
