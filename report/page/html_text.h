// Stands in until the calibration pages include markup.h.
#pragma once

#include "report/markup.h"

namespace understudy::rehearsal {
using report::html_text;
}
