// Is an STL file whole? Its parser forgives what a printer must not.
#pragma once

#include <string>

namespace understudy::geometry {

/// Throws InputError for an empty file, a binary file whose size is not that of the triangles it announces,
/// and a text file with a malformed facet (naming its line) or without endsolid.
void check_stl_structure(const std::string& bytes, const std::string& file);

}  // namespace understudy::geometry
