#pragma once

namespace understudy::cli {

/// Says on standard error, where a plug-in is about to run without the box that the user would expect.
void warn_of_box(bool runs_plugins);

}  // namespace understudy::cli
