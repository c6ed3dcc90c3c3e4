#include <nlohmann/json.hpp>

#include "report/page/page_parts.h"

namespace understudy::report {

std::map<std::string, std::string> page_packages() {
  std::map<std::string, std::string> versions;
  for (const auto& package : nlohmann::json::parse(kPagePackages))
    versions[package.at("name")] = package.at("version");
  return versions;
}

}  // namespace understudy::report
