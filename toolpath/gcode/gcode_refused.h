// Lines that are refused, told together, so that a user need not mend a program line by line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace understudy::toolpath {

/// A line that changes what later lines mean, or that the dialect does not have.
struct RefusedLine {
  int line = 0, column = 0;
  std::string command;  ///< that it begins with, upper case
  std::string why;
};
constexpr int kMostRefused = 20;  ///< lines that are told

struct RefusedLines {
  std::vector<RefusedLine> told;
  int lines = 0;  ///< of all

  void add(const InputError& error, const std::string& command);
};

/// What `error` says without the place ahead of it.
std::string without_place(const InputError& error);

/// A command that does nothing the twin knows of: --ignore can pass over all its lines.
bool can_be_ignored(std::string_view command);

}  // namespace understudy::toolpath
