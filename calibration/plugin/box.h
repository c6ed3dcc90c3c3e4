// What keeps a program of strangers from outliving us, and from reaching more than it needs.
#pragma once

#include <string>
#include <vector>

namespace understudy::calibration {

/// The words that run `command` by /bin/sh so that it dies with us. Where bubblewrap is installed and works,
/// it has no network, may write only below $TMPDIR, a folder of its own in memory, and sees no processes but
/// its own; $UNDERSTUDY_PLUGIN_BOX=off leaves that out.
std::vector<std::string> boxed(const std::string& command);

/// Whether boxed() uses bubblewrap.
bool has_box();

/// The name of a run, as an environment variable that all it starts inherits, whatever session they begin.
std::string next_run_mark();

/// Kills every process that has the mark in its environment.
void kill_marked(const std::string& mark);

}  // namespace understudy::calibration
