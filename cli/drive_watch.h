// A print on a real machine that browsers of this computer look at while it goes (cli/watch/drive_watch.cpp).
#pragma once

#include <memory>
#include <string>

#include "cli/drive/watched_port.h"
#include "machine/description.h"

namespace understudy::cli {

class DriveWatch {
 public:
  virtual ~DriveWatch() = default;
  virtual void moved(const SeenMotion& seen) = 0;
  virtual void progress(double share) = 0;
  /// The print is complete: browsers are told, and waited for, 5 s at most.
  virtual void complete() = 0;
};

/// Tells the address on standard error. Throws InputError where the port cannot be had, and in the build
/// without the twin, which has no page.
std::unique_ptr<DriveWatch> watch_drive(const machine::MachineDescription& machine,
                                        const std::string& program, int port);

}  // namespace understudy::cli
