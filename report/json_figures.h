// The figures of a JSON file under dotted names.
#pragma once

#include <map>
#include <string>
#include <variant>

namespace understudy::report {

/// Numbers and words: "reachable.fraction". Items of a list count from 0; where each item is an object that
/// begins with a word of its own, this word is its name: "results.robust.median_um". True and false are
/// words; null is left out. Throws InputError for text that is no JSON.
std::map<std::string, std::variant<double, std::string>> json_figures(const std::string& text,
                                                                      const std::string& file);

}  // namespace understudy::report
