#include "machine/port.h"

namespace understudy::machine {

const char* to_string(Status s) {
  switch (s) {
    case Status::ok:
      return "ok";
    case Status::queue_full:
      return "queue full";
    case Status::deadline_exceeded:
      return "deadline exceeded";
    case Status::faulted:
      return "faulted";
    case Status::rejected:
      return "rejected";
    case Status::no_frame:
      return "no frame";
  }
  return "unknown status";
}

const char* to_string(Fault f) {
  switch (f) {
    case Fault::none:
      return "no fault";
    case Fault::following_error:
      return "following error";
    case Fault::underrun:
      return "queue underrun";
    case Fault::limit_switch:
      return "limit switch";
    case Fault::drive:
      return "drive fault";
    case Fault::power:
      return "power cut";
    case Fault::emergency_stop:
      return "emergency stop";
    case Fault::engine:
      return "engine failure";
  }
  return "unknown fault";
}

}  // namespace understudy::machine
