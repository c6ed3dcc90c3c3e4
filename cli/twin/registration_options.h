// What `register` and `rehearse --register` share.
#pragma once

#include <CLI/App.hpp>

#include "rehearsal/record.h"
#include "rehearsal/request/request.h"

namespace understudy::cli {

/// Adds --pattern and --places.
void add_registration_options(CLI::App& command, rehearsal::RegistrationRequest& request);

/// Where the part was found, or why it was not, on standard output.
void print_registration(const rehearsal::RegistrationFigures& figures);

}  // namespace understudy::cli
