#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "cli/twin/rehearse_options.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/output_folder.h"
#include "report/comparison_json.h"
#include "report/page/comparison_page.h"
#include "report/page/comparison_tables.h"
#include "report/recorded/rehearsal_comparison.h"

namespace understudy::cli {
namespace {
namespace fs = std::filesystem;
using report::RecordedRehearsal;

struct CompareRequest {
  std::string a, b, folder;
  bool json = false, fail_on_change = false;
};

bool is_same_folder(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

void check_folders(const CompareRequest& r) {
  if (is_same_folder(r.a, r.b))
    throw InputError(fmt::format("{} and {} are the same folder: name two", r.a, r.b));
  for (const std::string& result : {r.a, r.b})
    if (!r.folder.empty() && is_same_folder(result, r.folder))
      throw InputError(
          fmt::format("--out {} is one of the results that are compared: name another", r.folder));
}

/// A command of another kind, such as a scenario's, is one input as a whole.
void add_options(RecordedRehearsal& result) {
  try {
    result.inputs.merge(rehearse_option_words(result.run.command));
  } catch (const InputError&) {
    result.inputs["command"] = result.run.command;
  }
}

void write_comparison(const std::string& folder, const std::string& json, const std::string& html) {
  OutputFolder out(folder);
  write_file(out.path() / "compare.json", json);
  write_file(out.path() / "compare.html", html);
  out.commit();
}

int compare(const CompareRequest& r) {
  check_folders(r);
  RecordedRehearsal a = report::read_recorded_rehearsal(r.a), b = report::read_recorded_rehearsal(r.b);
  if (a.run.inputs_sha256 != b.run.inputs_sha256)  // else they differ in names alone
    for (RecordedRehearsal* result : {&a, &b}) add_options(*result);
  const report::RehearsalComparison comparison = report::compare_rehearsals(a, b);
  const std::string json = report::comparison_json(comparison, a, b);
  if (!r.folder.empty()) write_comparison(r.folder, json, report::comparison_html(comparison, a, b));
  fmt::print("{}", r.json ? json : report::comparison_text(comparison, a, b));
  if (!r.folder.empty() && !r.json) fmt::print("\n{}\n", (fs::path(r.folder) / "compare.html").string());
  return r.fail_on_change && comparison.differs() ? kNo : kGood;
}

}  // namespace

void add_compare(CLI::App& app, Action& action) {
  auto request = std::make_shared<CompareRequest>();
  auto* command =
      app.add_subcommand("compare", "Tell what differs between two rehearsals: inputs, findings, figures");
  command->add_option("a", request->a, "results of understudy rehearse, the earlier ones")->required();
  command->add_option("b", request->b, "results of understudy rehearse, the later ones")->required();
  command->add_flag("--json", request->json, "print the comparison as JSON (docs/comparing.md)");
  command->add_flag("--fail-on-change", request->fail_on_change,
                    "status 1 where verdict, findings, figures or curves differ");
  command->add_option("--out", request->folder, "also write compare.html and compare.json into this folder");
  command->callback([=, &action] { action = [=] { return compare(*request); }; });
}

}  // namespace understudy::cli
