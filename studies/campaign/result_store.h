// The runs of a campaign in a SQLite file: one row a run, append-only (docs/campaigns.md#result-store).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "studies/campaign/run_row.h"

namespace understudy::studies {

constexpr int kStoreVersion = 1;

/// What tells one campaign's store from another's.
struct StoreHeader {
  std::string campaign;       ///< its name
  std::string inputs_sha256;  ///< of the campaign and all its inputs
  std::string version;        ///< of this program
  std::vector<std::string> parameters;
};

/// What a store is for.
enum class StoreUse {
  part,    ///< of one process, which holds it from the beginning to the end: a row costs one flush of its log
  merged,  ///< that people read meanwhile: who has it open does not keep rows from coming
};

/// A file that one process writes. Rows are durable when add() returns. Throws InputError for a file of
/// another schema version, campaign or program version, one that is none, and one that another process is
/// writing; MachineError where the disk fails.
class ResultStore {
 public:
  /// Opens it, or begins it.
  ResultStore(const std::filesystem::path& path, const StoreHeader& header, StoreUse use = StoreUse::part);
  ~ResultStore();
  ResultStore(ResultStore&&) noexcept;
  ResultStore& operator=(ResultStore&&) noexcept;

  void add(const RunRow& row);
  /// All at once or none; those that are there already stay as they are.
  void add_all(const std::vector<RunRow>& rows);

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

/// Indexes of the rows of a file; throws as ResultStore.
std::set<std::uint64_t> stored_runs(const std::filesystem::path& path, const StoreHeader& header);

/// Rows by index, ascending, from `begin` to before `end`.
std::vector<RunRow> read_rows(const std::filesystem::path& path, const StoreHeader& header,
                              std::uint64_t begin = 0, std::uint64_t end = std::uint64_t{1} << 62);

/// Another process has it open as a ResultStore.
bool being_written(const std::filesystem::path& path);

/// Nothing where there is no such file. Throws InputError for what is no store of this schema version.
std::optional<StoreHeader> read_header(const std::filesystem::path& path);

}  // namespace understudy::studies
