// How far a long task is, for whoever shows it.
#pragma once

#include <functional>
#include <string>

namespace understudy {

/// Share done of the whole task, 0..1, and what is being done. Empty: nobody looks.
using Progress = std::function<void(double share, const std::string& what)>;

}  // namespace understudy
