// The folder of `understudy campaign --out`: `runs.sqlite` with the runs so far, `parts/` with what workers
// have written and nobody has merged yet, and the tables, which appear when the campaign is done.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/file/descriptor.h"
#include "studies/campaign/campaign_result.h"
#include "studies/campaign/result_store.h"

namespace understudy::cli {

class CampaignFolder {
 public:
  CampaignFolder(std::filesystem::path path, studies::StoreHeader header);

  /// To be the one that runs the campaign. Throws InputError where another is, where the folder holds
  /// something else, another campaign, or runs of this one without `resume`.
  void take(bool resume);
  /// For what a campaign has started: throws InputError where the folder is not of this campaign, its inputs
  /// and this version.
  void check() const;

  const std::filesystem::path& path() const { return path_; }
  const studies::StoreHeader& header() const { return header_; }
  std::filesystem::path part(const std::string& name) const { return path_ / "parts" / (name + ".sqlite"); }

  /// Runs below `end` that neither the store nor any part has, ascending. Parts that another process is
  /// writing do not count. `name_begins`: only parts of such a name count.
  std::vector<std::uint64_t> missing(std::uint64_t end, const std::string& name_begins = "") const;
  /// Takes the rows below `end` from all parts into the store, by index, and removes parts that have no
  /// others.
  void merge(std::uint64_t end);
  std::vector<studies::RunRow> rows(std::uint64_t begin, std::uint64_t end) const;

 private:
  std::filesystem::path store() const { return path_ / "runs.sqlite"; }
  std::vector<std::filesystem::path> parts() const;
  void refuse(const std::string& why) const;

  std::filesystem::path path_;
  studies::StoreHeader header_;
  Descriptor lock_;
};

}  // namespace understudy::cli
