// Mitsuba's <transform>.
#pragma once

#include <Eigen/Core>

#include "scenes/xml_reader.h"

namespace halfslope {

/// The affine map of a <transform>: its <translate>, <scale>, <rotate>, <lookat> and <matrix>, the first applied first.
/// Error(kBadInput) with the place for any other element, a rotation axis that is not unit length (Mitsuba does not
/// normalise it), a lookat without direction, a matrix whose last row is not 0 0 0 1.
Eigen::Matrix4d read_transform(const Element& transform);

}  // namespace halfslope
