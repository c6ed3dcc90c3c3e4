// The file that an error belongs to, where what found it does not know files.
#pragma once

#include <string>

#include "core/error.h"

namespace understudy {

/// What `work` returns. An InputError without a place gets `file` for one; an empty name adds nothing.
template <typename Work>
auto in_context_of(const std::string& file, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    if (file.empty() || !error.place().file.empty()) throw;
    throw InputError(Place{file}, error.what());
  }
}

/// Without the place that it begins with.
inline std::string message_without_place(const InputError& error) {
  const std::string message = error.what(), place = to_string(error.place()) + ": ";
  return message.starts_with(place) ? message.substr(place.size()) : message;
}

}  // namespace understudy
