// Reads a YAML mapping key by key and refuses what nobody asked for. Private to this room.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "core/error.h"

namespace understudy::rehearsal {

/// A mapping of the file. Every error is an InputError with file and line. `what` names the mapping in
/// messages: "the scenario", "an expectation". Keys that were never read are errors in close().
class StrictMap {
 public:
  StrictMap(const YAML::Node& node, std::string file, std::string what);

  bool has(const std::string& key);
  std::string text(const std::string& key);  ///< not empty
  double number(const std::string& key);     ///< finite
  std::uint64_t whole_number(const std::string& key);
  std::vector<double> numbers(const std::string& key, std::size_t count);
  StrictMap map(const std::string& key, const std::string& what);
  std::vector<StrictMap> list_of_maps(const std::string& key, const std::string& what);  ///< not empty
  /// One of `words`; anything else names the nearest.
  std::string word(const std::string& key, const std::vector<std::string>& words);
  bool holds_number(const std::string& key);

  /// Throws for the first key in the file that was not asked for, naming the nearest of those that were.
  void close() const;
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;  ///< at the key's line
  int line() const;
  Place place() const { return {file_, line(), 0}; }

 private:
  YAML::Node required(const std::string& key);
  YAML::Node scalar(const std::string& key);
  Place place(const YAML::Node& node) const;
  double to_number(const YAML::Node& node, const std::string& key) const;

  YAML::Node node_;
  std::string file_, what_;
  std::set<std::string> asked_;
};

/// Parses the file's text; a syntax error becomes an InputError with its line.
YAML::Node parse_yaml(const std::string& text, const std::string& file);

}  // namespace understudy::rehearsal
