// The page of a rehearsal, embedded at build time: cmake/web.cmake says from where.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace understudy::report {

extern const std::string_view kPageTemplate;
extern const std::string_view kPageStyle;
extern const std::string_view kPageScript;
extern const std::string_view kPlotsStyle;    ///< of the plots' library
extern const std::string_view kPageNotices;   ///< licences of what the script has of others
extern const std::string_view kPagePackages;  ///< what that is: name, version and licence, in JSON

/// The libraries within the page and their versions; none in the plain page of a build without npm.
std::map<std::string, std::string> page_packages();

}  // namespace understudy::report
