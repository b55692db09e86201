#include "scenes/upgrade.h"

#include <cctype>
#include <string_view>

namespace halfslope {
namespace {

bool is_lower(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }
bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }

void upgrade_element(pugi::xml_node element, std::string_view parent_type) {
  const std::string_view tag = element.name();
  if (tag == "lookAt") element.set_name("lookat");
  if (const pugi::xml_attribute name = element.attribute("name"); name && tag != "default") {
    std::string upgraded = snake_case(name.value());
    if (upgraded == "diffuse_reflectance" && parent_type == "bsdf diffuse") upgraded = "reflectance";
    if (upgraded != name.value()) element.attribute("name").set_value(upgraded.c_str());
  }
  if (const pugi::xml_attribute id = element.attribute("id"); id && id.value()[0] == '_') {
    element.attribute("id").set_value((std::string("ID") + id.value() + "__UPGR").c_str());
  }
}

}  // namespace

std::string snake_case(std::string name) {
  for (std::size_t i = 0; i + 1 < name.size(); ++i) {
    if (!is_lower(name[i]) || !is_upper(name[i + 1])) continue;
    name.insert(i + 1, "_");
    for (i += 2; i < name.size() && is_upper(name[i]); ++i) {
      name[i] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
    }
  }
  return name;
}

void upgrade_names(pugi::xml_node root) {
  for (pugi::xml_node child : root.children()) {
    upgrade_element(child, std::string(root.name()) + " " + root.attribute("type").value());
    upgrade_names(child);
  }
}

}  // namespace halfslope
