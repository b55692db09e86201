// The light that a diffuse point receives from one unoccluded light, where it is known in closed form: E = π L F, and a
// surface of albedo ρ reflects ρ L F. Lengths may be in any unit; small, far, narrow and grazing lights keep their
// digits.
#pragma once

#include <optional>
#include <span>

#include "scenes/scene.h"

namespace halfslope {

/// The form factor E/(πL), in [0, 1], of a polygon seen from the origin with normal +z: Lambert's formula (1760),
/// ½ |Σ Θ_i Γ_i · z| / π over the edges, Θ_i the angle an edge subtends (by atan2) and Γ_i the normal of its plane.
/// What is below the horizon z = 0 is clipped away first. Where the edges' terms cancel, the sum is taken as the
/// integral ∫ cos θ cos ψ / (π r²) dA that it is, by Gauss's rule on triangles as small as that needs. Vertices in
/// order; planar; either orientation.
double polygon_form_factor(std::span<const Vec3> vertices);

/// The form factor E/(πL), in [0, 1], of the emitting side of a light seen from `position` with unit `normal`, with
/// nothing between: 0 for a light that faces away. Polygons by Lambert's formula; spheres by Snyder's ("Area Light
/// Sources for Real-Time Graphics", 1996), horizon included, and the inside of a sphere seen from within it 1; disks
/// and ellipses by the axis of the elliptical cone that they fill (Heitz & Hill, "Real-Time Line- and Disk-Light
/// Shading with Linearly Transformed Cosines", 2017). Nothing where there is no closed form: a disk that the horizon
/// cuts, a point on the light itself.
std::optional<double> form_factor(const Primitive& light, const Vec3& position, const Vec3& normal);

}  // namespace halfslope
