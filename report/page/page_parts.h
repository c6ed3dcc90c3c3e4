// The report's page, drawing and charts, embedded at build time from web/report/ and libjs-dygraphs.
#pragma once

#include <string_view>

namespace understudy::report {

extern const std::string_view kPageTemplate;
extern const std::string_view kPageStyle;
extern const std::string_view kPageFormat;
extern const std::string_view kPageElements;
extern const std::string_view kPageVerdict;
extern const std::string_view kPageTables;
extern const std::string_view kPageCharts;
extern const std::string_view kPageFrames;
extern const std::string_view kPageMain;
extern const std::string_view kDygraphScript;
extern const std::string_view kDygraphStyle;
extern const std::string_view kDygraphLicence;

/// Of the dygraphs that pages carry, as its script tells it: "2.2.1".
std::string_view dygraphs_version();

}  // namespace understudy::report
