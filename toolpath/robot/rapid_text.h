// Private to this folder: the text of a RAPID module as statements.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace understudy::toolpath {

struct RapidStatement {
  std::string word;       ///< its first name, upper case; of LOCAL PROC the second
  std::string_view text;  ///< whole, without its semicolon
  int line = 0;
};

/// Splits a module: each IF ... THEN, FOR ... DO, ENDIF, PROC NAME( ) is a statement of its own. Comments
/// become blanks in `text`, which the statements look into. Throws InputError for statements without an end
/// and bytes that belong to no program.
std::vector<RapidStatement> rapid_statements(std::string& text, const std::string& file);

}  // namespace understudy::toolpath
