// The tier of failures that are our own mistakes: a condition that holds by design, whatever a user or a
// machine does. Bad input throws InputError, a machine that fails MachineError (core/error.h), and what can
// happen in a control cycle returns a status.
#pragma once

namespace understudy {

/// Throws std::logic_error that names the condition, its place and why it must hold.
[[noreturn]] void fail_assertion(const char* condition, const char* file, int line, const char* why);

}  // namespace understudy

/// Checked in every build: `why` says what makes the condition hold.
#define UNDERSTUDY_ASSERT(condition, why) \
  ((condition) ? static_cast<void>(0) : ::understudy::fail_assertion(#condition, __FILE__, __LINE__, why))
