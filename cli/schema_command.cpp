#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "core/map_schema.h"
#include "core/output_file.h"
#include "machine/model_files.h"
#include "regression/scenario_file.h"
#include "report/json_schema.h"
#include "sim/as_built/as_built_file.h"

namespace understudy::cli {
namespace {

struct Kind {
  const char* word;
  const char* title;
  MapSchema (*schema)();
};

const Kind kKinds[] = {
    {"machine", "Understudy: description of a machine", machine::machine_schema},
    {"material", "Understudy: filament material", machine::material_schema},
    {"scenario", "Understudy: scenario", regression::scenario_schema},
    {"as-built", "Understudy: machine as built", sim::as_built_schema},
};

int write_schema(const Kind& kind, const std::string& output) {
  const std::string text = report::json_schema(kind.schema(), kind.title);
  if (output.empty()) {
    fmt::print("{}", text);
    return kGood;
  }
  write_file(output, text);
  fmt::print("{}\n", output);
  return kGood;
}

}  // namespace

void add_schema(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("schema", "Write the JSON Schema of a kind of YAML file, for editors");
  command->require_subcommand(1);
  auto output = std::make_shared<std::string>();
  for (const Kind& kind : kKinds) {
    auto* word = command->add_subcommand(kind.word, kind.title);
    word->add_option("-o,--output", *output, "file to write; without it, standard output");
    word->callback([=, &action, &kind] { action = [=, &kind] { return write_schema(kind, *output); }; });
  }
}

}  // namespace understudy::cli
