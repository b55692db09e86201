// Mitsuba's <transform>.
#pragma once

#include <Eigen/Core>

#include "scenes/xml_reader.h"

namespace halfslope {

/// The affine map of a <transform>: its <translate>, <scale>, <rotate>, <lookat> and <matrix>, the first applied first.
/// Error(kBadInput) with the place for any other element, a rotation axis that is not unit length (Mitsuba does not
/// normalise it), a lookat without direction, a matrix whose last row is not 0 0 0 1.
Eigen::Matrix4d read_transform(const Element& transform);

/// Of the unit vector n, the first of the two tangents that Mitsuba takes where it is free to choose (its
/// coordinate_system(); T. Duff and others, "Building an orthonormal basis, revisited", 2017).
Eigen::Vector3d any_perpendicular(const Eigen::Vector3d& n);

}  // namespace halfslope
