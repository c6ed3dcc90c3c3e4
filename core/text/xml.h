// XML documents, written by tinyxml2: it escapes names, and a number is printed with the digits that it is
// given.
#pragma once

#include <initializer_list>
#include <string>

#include <tinyxml2.h>

namespace understudy {

struct XmlAttribute {
  const char* name;
  std::string value;
};

/// A new last child of `parent`, with its attributes in the order given.
tinyxml2::XMLElement& add_element(tinyxml2::XMLNode& parent, const char* tag,
                                  std::initializer_list<XmlAttribute> attributes = {});

/// Indented by four spaces a level; ends with a newline.
std::string to_text(const tinyxml2::XMLDocument& document);

}  // namespace understudy
