#pragma once

#include <string>
#include <vector>

namespace understudy::calibration {

/// Our environment, as NAME=VALUE, reduced to what programs are found and run by: no tokens, passwords or
/// addresses of agents. What else a plug-in needs, its command can set ("NAME=VALUE ./mine").
std::vector<std::string> plugin_environment();

}  // namespace understudy::calibration
