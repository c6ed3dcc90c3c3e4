// Places in messages.
#pragma once

#include <string>

#include "core/frames.h"

namespace understudy::rehearsal {

/// "(1.20, 0.00, 3.10) mm", of metres.
std::string place_text(const Vec3& p_W);

}  // namespace understudy::rehearsal
