// The parts of a URI that names a port: SCHEME://PLACE?KEY=VALUE&KEY=VALUE.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace understudy::drivers {

struct PortUri {
  std::string text;    ///< as it was given, for messages
  std::string scheme;  ///< lower case: loopback, serial, tcp...
  std::string place;   ///< what follows ://, without options: a device, host:port
  std::map<std::string, std::string> options;

  /// The value of an option, or `otherwise`.
  std::string option(const std::string& key, const std::string& otherwise = {}) const;
  /// Throws InputError for an option that is not among these, naming the nearest.
  void check_options(const std::vector<std::string>& known) const;
  /// Throws InputError unless the option is a number from `low` to `high`; `otherwise` where it is not given.
  double number(const std::string& key, double otherwise, double low, double high) const;
};

/// Throws InputError for a text that is no such URI, and for an option that stands twice.
PortUri parse_port_uri(const std::string& text);

}  // namespace understudy::drivers
