#include <fmt/format.h>
#include <boost/version.hpp>

#include "control/library_versions.h"

namespace understudy::control {

std::string boost_version() {
  return fmt::format("{}.{}.{}", BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100);
}

}  // namespace understudy::control
