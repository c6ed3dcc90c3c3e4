#include "report/recorded/recorded_run.h"

#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file/output_folder.h"
#include "core/file/read_file.h"
#include "core/text/json_depth.h"

namespace understudy::report {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;

constexpr const char* kSchemaName = "understudy.rehearsal/";
constexpr const char* kSchema = "understudy.rehearsal/1";

/// Nothing where `object` is none or has no such text.
std::optional<std::string> text_at(const Json& object, const char* key) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? std::optional(found->get<std::string>())
                                                     : std::nullopt;
}

}  // namespace

void check_as_written(const fs::path& folder, const std::string& name) {
  if (!is_as_written(folder, name))
    throw InputError(Place{(folder / name).string()},
                     fmt::format("it is not the file that {} names: the result is not whole", kManifest));
}

RecordedRun read_recorded_run(const fs::path& folder) {
  const fs::path file = folder / "summary.json";
  const auto refuse = [&](const std::string& why) -> InputError { return {{file.string()}, why}; };
  const std::string text = read_file(file);
  if (nests_deeper(text)) throw refuse(fmt::format("it is nested more than {} deep", kJsonDepthMax));
  const Json summary = Json::parse(text, nullptr, false);
  const std::string schema = text_at(summary, "schema").value_or("");
  if (schema.starts_with(kSchemaName) && schema != kSchema)
    throw refuse(
        fmt::format("it is '{}', where this program reads {}: run the rehearsal again", schema, kSchema));
  if (schema != kSchema)
    throw refuse("it is no summary of a rehearsal: name a folder that understudy rehearse wrote");
  const auto provenance = summary.find("provenance");
  const auto word = [&](const char* key) {
    auto value = provenance == summary.end() ? std::nullopt : text_at(*provenance, key);
    if (!value) throw refuse(fmt::format("provenance.{} is missing: an older version wrote it", key));
    return *value;
  };
  return {word("command"),
          word("version"),
          word("machine_sha256"),
          word("program_sha256"),
          word("inputs_sha256"),
          text_at(*provenance, "fixture_sha256").value_or(""),
          text_at(summary, "verdict") == "go"};
}

}  // namespace understudy::report
