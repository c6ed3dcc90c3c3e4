// The machine that a command or a request means when it names none.
#pragma once

namespace understudy::machine {

constexpr const char* kDefaultMachine = "hexapod";  ///< a folder under models/

}  // namespace understudy::machine
