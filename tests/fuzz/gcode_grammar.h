// Programs that keep the rules of docs/gcode.md, out of bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "tests/fuzz/gcode_dialects.h"

namespace understudy::fuzz {

/// A program in that dialect which the reader must accept; the same bytes give the same program.
std::string grammatical_program(std::span<const std::uint8_t> bytes, const Dialect& dialect);

}  // namespace understudy::fuzz
