#include "cli/output_options.h"

namespace understudy::cli {

void add_quiet_option(CLI::App& command, OutputOptions& options, const std::string& what) {
  command.add_flag("-q,--quiet", options.quiet, what);
}

void add_json_option(CLI::App& command, OutputOptions& options, const std::string& what) {
  command.add_flag("--json", options.json, "print " + what + " as one JSON document on standard output");
}

}  // namespace understudy::cli
