// Keyword arguments that stand for the options of `understudy rehearse`.
#pragma once

#include <string>

#include <pybind11/pybind11.h>

#include "rehearsal/request/request.h"

namespace understudy::python {

/// The request that these options make, None for those that are left out; its `command` is the command line
/// that asks for the same. Throws InputError for an option that is unknown (with the nearest one), of another
/// type or outside its range. `program` empty: none.
rehearsal::RehearsalRequest request_of(const std::string& program, const pybind11::dict& options);

}  // namespace understudy::python
