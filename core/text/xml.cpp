#include "core/text/xml.h"

namespace understudy {

tinyxml2::XMLElement& add_element(tinyxml2::XMLNode& parent, const char* tag,
                                  std::initializer_list<XmlAttribute> attributes) {
  tinyxml2::XMLElement* element = parent.GetDocument()->NewElement(tag);
  parent.InsertEndChild(element);
  for (const XmlAttribute& a : attributes) element->SetAttribute(a.name, a.value.c_str());
  return *element;
}

std::string to_text(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace understudy
