#include "core/process/pipe.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "core/error.h"

namespace understudy {

Pipe::Pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw MachineError("cannot make a pipe: " + std::generic_category().message(errno));
  read = Descriptor(ends[0]);
  write = Descriptor(ends[1]);
}

}  // namespace understudy
