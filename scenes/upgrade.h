// Scene files of Mitsuba 0.x in the spelling of Mitsuba 3.
#pragma once

#include <pugixml.hpp>
#include <string>

namespace halfslope {

/// camelCase as snake_case, the way Mitsuba 3 does it: toWorld → to_world, intIOR → int_ior.
std::string snake_case(std::string name);

/// What Mitsuba 3 does to a tree whose version is below 2 (its upgrade_tree): every `name` but a <default>'s becomes
/// snake_case, <lookAt> becomes <lookat>, an id that begins with "_" becomes "ID_…__UPGR", and the
/// diffuse_reflectance of a diffuse bsdf becomes its reflectance. The offsets and scales of a texture (uoffset, …) are
/// left to its reader. The tree must not be deeper than kMaxXmlDepth.
void upgrade_names(pugi::xml_node root);

}  // namespace halfslope
