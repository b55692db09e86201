// The parts of a Mitsuba scene, each from its element. All throw Error(kBadInput) with file:line.
#pragma once

#include <map>
#include <string>

#include "scenes/scene.h"
#include "scenes/xml_reader.h"

namespace halfslope {

/// <bsdf>: diffuse, phong, or roughconductor with distribution ggx.
Bsdf read_bsdf(const Element& bsdf);

/// <shape>: sphere, rectangle or disk, with its bsdf (or a <ref> to one of `bsdfs`, by id) and area emitter. `position`
/// counts the shapes from 1 and names the one that has no id.
Primitive read_shape(const Element& shape, const std::map<std::string, Bsdf>& bsdfs, std::size_t position);

/// <sensor>: perspective, radiancemeter or mradiancemeter.
Sensor read_sensor(const Element& sensor);

}  // namespace halfslope
