// Whether a program fits where it stands, at a glance.
#pragma once

#include <string>

#include "rehearsal/request/request.h"

namespace understudy::rehearsal {

/// The limit that the program breaks most at the request's place, in words with its line, by some of its
/// poses; empty where these hold, and for a program that prints nothing. Throws InputError as a rehearsal of
/// the request would.
std::string misfit(const RehearsalRequest& request);

}  // namespace understudy::rehearsal
