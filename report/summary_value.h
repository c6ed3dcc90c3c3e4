// Stands in until the calibration pages include json_text.h and core/stable_number.h.
#pragma once

#include "core/stable_number.h"
#include "report/json_text.h"

namespace understudy::rehearsal {
using report::to_text;
}
