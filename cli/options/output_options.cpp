#include "cli/options/output_options.h"

#include <fmt/format.h>

namespace understudy::cli {

void add_quiet_option(CLI::App& command, OutputOptions& options, const std::string& what) {
  command.add_flag("-q,--quiet", options.quiet, what);
}

void add_json_option(CLI::App& command, OutputOptions& options, const std::string& what) {
  command.add_flag("--json", options.json, "print " + what + " as one JSON document on standard output");
}

void add_output_options(CLI::App& command, OutputOptions& options, const std::string& least,
                        const std::string& document) {
  add_quiet_option(command, options, "no progress, and " + least);
  add_json_option(command, options, document);
}

void print_answer(const OutputOptions& options, const Answer& answer) {
  fmt::print("{}", options.json ? answer.json : options.quiet ? answer.least : answer.whole);
}

}  // namespace understudy::cli
