// A session with a controller that says what it is told to say, right or wrong.
#pragma once

#include <string_view>

namespace understudy::fuzz {

/// The first byte chooses the family, the second in pieces of how many bytes the rest of `input` comes, which
/// is what the controller says; at a form feed it waits until it is sent something. True: it ended with all
/// that was sent done; else it was refused, or ended with a fault. Throws Finding where it ends in none of
/// these, or calls more lines done than were accepted.
bool talk(std::string_view input);

}  // namespace understudy::fuzz
