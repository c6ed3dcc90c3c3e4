// How much a command tells on its two streams, and in what form.
#pragma once

#include <string>

#include <CLI/App.hpp>

namespace understudy::cli {

struct OutputOptions {
  bool quiet = false;  ///< no progress, and of the answer the least
  bool json = false;   ///< the answer is one JSON document on standard output
};

/// Both of the options below. `least` is what `--quiet` leaves, `document` what `--json` prints.
void add_output_options(CLI::App& command, OutputOptions& options, const std::string& least,
                        const std::string& document);
/// `what` is still told, in words for the help. `options` must outlive `command`.
void add_quiet_option(CLI::App& command, OutputOptions& options, const std::string& what);
/// `what` the document is: "the summary".
void add_json_option(CLI::App& command, OutputOptions& options, const std::string& what);

/// An answer in its three forms, each with its line ends.
struct Answer {
  std::string whole, least, json;
};
/// Prints the form that was asked for, on standard output.
void print_answer(const OutputOptions& options, const Answer& answer);

}  // namespace understudy::cli
