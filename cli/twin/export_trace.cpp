#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "core/file/output_file.h"
#include "report/recorded/recorded_run.h"
#include "report/trace/trace_hdf5.h"

namespace understudy::cli {
namespace {

struct TraceRequest {
  std::string folder, output;
};

int export_trace(const TraceRequest& r) {
  check_writable(r.output);
  const report::RecordedRun run = report::read_recorded_run(r.folder);
  for (const char* name : {"summary.json", "trace.csv"}) report::check_as_written(r.folder, name);
  const report::TraceTable table = report::read_trace_table(std::filesystem::path(r.folder) / "trace.csv");
  write_file(r.output, report::trace_hdf5(table, {{"schema", "understudy.trace/1"},
                                                  {"version", run.version},
                                                  {"inputs_sha256", run.inputs_sha256},
                                                  {"command", run.command}}));
  fmt::print("{}: {} columns of {} rows\n", r.output, table.names.size(), table.rows());
  return kGood;
}

}  // namespace

void add_export_trace(CLI::App& exported, Action& action) {
  auto request = std::make_shared<TraceRequest>();
  auto* command =
      exported.add_subcommand("trace", "HDF5 by columns of a rehearsal's trace, for pandas, MATLAB or Julia");
  command->add_option("folder", request->folder, "results of `understudy rehearse`")->required();
  command->add_option("-o,--output", request->output, "file to write")->required();
  command->footer(
      "In Python:\n"
      "  with h5py.File('trace.h5') as f: pandas.DataFrame({name: f['trace'][name][:] for name in "
      "f['trace']})");
  command->callback([=, &action] { action = [=] { return export_trace(*request); }; });
}

}  // namespace understudy::cli
