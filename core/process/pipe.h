// A pipe between processes.
#pragma once

#include "core/file/descriptor.h"

namespace understudy {

/// Both ends, which a program that is started does not inherit.
struct Pipe {
  /// Throws MachineError.
  Pipe();
  Descriptor read, write;
};

}  // namespace understudy
