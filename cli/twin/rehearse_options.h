// The options of `understudy rehearse`, for whoever runs that command or reads its words in a record.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "cli/options/output_options.h"
#include "cli/options/watch_options.h"
#include "rehearsal/request/request.h"

namespace understudy::cli {

struct RehearseOptions {
  rehearsal::RehearsalRequest request;
  std::vector<std::string> faults;   ///< in the words of scenarios
  std::string folder = "rehearsal";  ///< of results
  std::string video;                 ///< a film of the run; empty: none
  WatchOptions watch;                ///< show the growing report in a browser
  OutputOptions output;

  /// The request with its faults; throws InputError for words that tell none.
  rehearsal::RehearsalRequest with_faults() const;
};

/// `options` must outlive `command`.
void add_rehearse_options(CLI::App& command, RehearseOptions& options);

/// What a command line asks for, `understudy rehearse ...` word by word as command_line() joined them.
/// Throws InputError for any other command and for words that are not understood.
RehearseOptions read_rehearse_command(const std::string& command_line);

/// What such a command line gives for each argument and option that can change the answer and no record tells
/// otherwise, by name: "program",
/// "--gap-control". Throws as read_rehearse_command().
std::map<std::string, std::string> rehearse_option_words(const std::string& command_line);

/// Whether `file` lies in `folder` or below it; neither need be there.
bool is_among(const std::string& file, const std::string& folder);

/// `file` where it lies outside of `folder`; else its place in `working`, where that folder is being made.
std::string among_results(const std::string& file, const std::string& folder, const std::string& working);

}  // namespace understudy::cli
