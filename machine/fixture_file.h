#pragma once

#include <string>

namespace understudy::machine {

/// Path of a fixture: a file, or NAME for models/parts/NAME.stl. Throws InputError naming the known ones.
std::string find_fixture(const std::string& fixture);

}  // namespace understudy::machine
