// A run that browsers look at while it goes.
#pragma once

#include "cli/watch/live_server.h"
#include "report/page/live_record.h"

namespace understudy::cli {

struct WatchedRun {
  /// Tells the address on standard error.
  explicit WatchedRun(int port);

  report::LiveRecord record;
  LiveServer server;
};

}  // namespace understudy::cli
