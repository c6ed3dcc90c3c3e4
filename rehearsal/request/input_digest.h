// One fingerprint of everything that a rehearsal's answer depends on.
#pragma once

#include <string>

#include "rehearsal/request/request.h"

namespace understudy::rehearsal {

/// SHA-256, hexadecimal, of the version, of the bytes of every input file (program, machine and its URDF,
/// machine before, fixture, material, as-built, intended surface, pattern) and of every option. Names and
/// folders of files, the command and where results go do not count. Throws InputError for a file that cannot
/// be read. `program_sha256`: of the program's bytes where they are read already; empty: reads them.
std::string inputs_sha256(const RehearsalRequest& request, const std::string& program_sha256 = {});

}  // namespace understudy::rehearsal
