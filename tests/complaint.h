// What a call says of bad input.
#pragma once

#include <string>

#include "core/error.h"

namespace understudy {

/// The message of the InputError that the call throws; "accepted" where it throws none.
template <typename Call>
std::string complaint(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace understudy
