// What keeps a program of strangers from outliving us, and from reaching more than it needs.
#pragma once

#include <string>
#include <vector>

#include "calibration/plugin/process_limits.h"

namespace understudy::calibration {

/// The words that run `command` by /bin/sh so that it dies with us, gains no privileges, and has the limits
/// of files, memory and CPU time of one process that the kernel can keep. Where has_box(), it also sees
/// what docs/calibration-plugins.md tells and no more.
std::vector<std::string> boxed(const std::string& command, const ProcessLimits& limits);

/// Whether boxed() uses bubblewrap: it is installed, may make namespaces here, and $UNDERSTUDY_PLUGIN_BOX is
/// not "off".
bool has_box();

/// What a user should know before a program runs: one line where the box is wanted and cannot be had; else
/// empty.
std::string box_warning();

/// The name of a run, as an environment variable that all it starts inherits, whatever session they begin.
std::string next_run_mark();

/// Kills every process that has the mark in its environment.
void kill_marked(const std::string& mark);

}  // namespace understudy::calibration
