// The answer in one sentence.
#pragma once

#include <string>

#include "rehearsal/record.h"

namespace understudy::rehearsal {

/// For people: why it is a go, or what stands against it.
std::string verdict_sentence(const Record& record);

}  // namespace understudy::rehearsal
