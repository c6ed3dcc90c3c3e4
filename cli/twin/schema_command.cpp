#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "calibration/table/column_map.h"
#include "cli/command.h"
#include "control/registration/part_pose_file.h"
#include "core/file/output_file.h"
#include "core/yaml/map_schema.h"
#include "machine/default_machine.h"
#include "machine/description.h"
#include "machine/fixture_file.h"
#include "machine/material.h"
#include "machine/model_files.h"
#include "regression/golden_file.h"
#include "regression/scenario_file.h"
#include "report/json_schema.h"
#include "sim/as_built/as_built_file.h"
#include "studies/campaign/campaign_file.h"
#include "vision/boards/rig_file.h"

namespace understudy::cli {
namespace {

struct SchemaRequest {
  std::string output, file, machine = machine::kDefaultMachine;
};

struct Kind {
  const char* word;
  const char* title;
  MapSchema (*schema)();
  void (*read)(const SchemaRequest& request);
};

const Kind kKinds[] = {
    {"machine", "Understudy: description of a machine", machine::machine_schema,
     [](const SchemaRequest& r) { machine::load_machine(r.file); }},
    {"material", "Understudy: filament material", machine::material_schema,
     [](const SchemaRequest& r) { machine::load_material(r.file); }},
    {"scenario", "Understudy: scenario", regression::scenario_schema,
     [](const SchemaRequest& r) { regression::load_scenario(r.file); }},
    {"campaign", "Understudy: campaign", studies::campaign_schema,
     [](const SchemaRequest& r) { studies::load_campaign(r.file); }},
    {"golden", "Understudy: golden figures of a scenario", regression::golden_schema,
     [](const SchemaRequest& r) { regression::load_golden(r.file); }},
    {"as-built", "Understudy: machine as built", sim::as_built_schema,
     [](const SchemaRequest& r) { sim::make_as_built(machine::load_machine(r.machine), r.file, 1); }},
    {"fixture", "Understudy: what is clamped on a table", machine::fixture_schema,
     [](const SchemaRequest& r) { machine::check_fixture_file(r.file); }},
    {"part-pose", "Understudy: where a clamped part was found", control::part_pose_schema,
     [](const SchemaRequest& r) { control::read_part_pose(r.file); }},
    {"rig", "Understudy: two cameras that measure a machine", vision::rig_schema,
     [](const SchemaRequest& r) { vision::load_rig(r.file); }},
    {"columns", "Understudy: columns of tables of measurements", calibration::column_map_schema,
     [](const SchemaRequest& r) { calibration::read_column_map(r.file); }},
};

int run_schema(const Kind& kind, const SchemaRequest& request) {
  if (!request.output.empty()) check_writable(request.output);
  if (!request.file.empty()) {
    kind.read(request);
    fmt::print("{}: ok\n", request.file);
    return kGood;
  }
  const std::string text = report::json_schema(kind.schema(), kind.title);
  if (request.output.empty()) {
    fmt::print("{}", text);
    return kGood;
  }
  write_file(request.output, text);
  fmt::print("{}\n", request.output);
  return kGood;
}

}  // namespace

void add_schema(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "schema", "Write the JSON Schema of a kind of YAML file, for editors, or check a file");
  command->require_subcommand(1);
  auto request = std::make_shared<SchemaRequest>();
  for (const Kind& kind : kKinds) {
    auto* word = command->add_subcommand(kind.word, kind.title);
    word->add_option("-o,--output", request->output, "file to write; without it, standard output");
    word->add_option("--check", request->file, "instead: read this file and say what is wrong with it");
    if (kind.schema == sim::as_built_schema)
      word->add_option("--machine", request->machine, "whose errors the file tells")->capture_default_str();
    word->callback([=, &action, &kind] { action = [=, &kind] { return run_schema(kind, *request); }; });
  }
}

}  // namespace understudy::cli
