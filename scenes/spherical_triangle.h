// The solid angle of a triangle seen from the origin, and its points drawn uniformly in solid angle: both by forms that
// hold from the smallest triangle to almost a hemisphere, so that neither needs a threshold.
//
// A triangle is a corner relative to the receiver and the two edges from there. The edges are of the triangle itself: a
// caller who subtracts its corners, not the corners less the receiver, keeps a small triangle's digits far away.
#pragma once

#include <limits>

#include "core/packet.h"
#include "scenes/vec.h"

namespace halfslope {

/// A point of a triangle: position = b0·corner0 + b1·corner1 + b2·corner2, relative to the receiver.
template <class F>
struct TrianglePoint {
  Vec<F> position;
  F b0, b1, b2;   ///< barycentric, in [0, 1]; b0 belongs to the corner, b1 and b2 to the ends of the edges
  F solid_angle;  ///< of the triangle, in sr: the density of the direction is its inverse; 0 where seen edge-on
};

namespace spherical {

/// a where the mask holds, else b.
template <class F>
inline Vec<F> either(const mask_t<F>& mask, const Vec<F>& a, const Vec<F>& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// tan(γ/2) of the angle γ in [0, π) between two vectors, from |a × b|, a·b and |a||b|: of the two forms the one whose
/// sum does not cancel. At most 10¹⁷, so that its square is a number: γ is then π to all digits.
template <class F>
inline F tan_half_angle(const F& cross, const F& dot_product, const F& lengths) {
  const F zero(scalar_t<F>(0)), one(scalar_t<F>(1));
  const auto acute = dot_product >= zero;
  const F above = select(acute, cross, lengths - dot_product), below = select(acute, lengths + dot_product, cross);
  return min(above / select(below > zero, below, one), F(scalar_t<F>(1e17)));
}

/// sin γ from tan(γ/2).
template <class F>
inline F sin_of_half(const F& tan_half) {
  return F(scalar_t<F>(2)) * tan_half / fma(tan_half, tan_half, F(scalar_t<F>(1)));
}

/// A point on a flat edge: its shares of the way to either end, which sum to 1, and its distance from the origin.
template <class F>
struct EdgePoint {
  F to_0, to_1;  ///< position = to_0·end₀ + to_1·end₁, each with its own digits
  F distance;
};

/// Where on an edge with ends at distances l₀ and l₁, seen under the angle γ, the angle σ from end 0 has been covered,
/// from the tangents of half the angles. By the law of sines the shares are as l₁ sin(γ − σ) to l₀ sin σ, and the
/// distance is l₀l₁ sin γ over their sum. All terms are positive.
template <class F>
inline EdgePoint<F> point_of_edge(const F& length_0, const F& length_1, const F& sine_times_lengths,
                                  const F& tan_half_covered, const F& tan_half_all) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1));
  const F covered = min(tan_half_covered, tan_half_all);
  const F left = (tan_half_all - covered) / fma(covered, tan_half_all, one);
  const F to_0 = length_1 * sin_of_half(left), to_1 = length_0 * sin_of_half(covered), sum = to_0 + to_1;
  const auto edge = sum > zero;
  const F scale = one / select(edge, sum, one);
  return {select(edge, to_0 * scale, one), to_1 * scale, select(edge, sine_times_lengths * scale, length_0)};
}

/// The vector of length l in the plane of a and its normal n = a × b, turned from a towards b by an angle given by the
/// tangent of its half.
template <class F>
inline Vec<F> turned(const Vec<F>& a, const F& length_a, const Vec<F>& n, const F& length_n, const F& tan_half,
                     const F& l) {
  const F one(scalar_t<F>(1)), scale = l / (fma(tan_half, tan_half, one) * length_a);
  const F ahead = scale * (one - tan_half) * (one + tan_half);
  const F aside = scale * (tan_half + tan_half) / max(length_n, F(std::numeric_limits<scalar_t<F>>::min()));
  return ahead * a + aside * cross(n, a);
}

/// What of a triangle is the same for all its points, in a unit of length that keeps products of three in range.
template <class F>
struct Triangle {
  Vec<F> corner, edge_1, edge_2;
  F unit;                          ///< lengths here per length outside
  F length_0, length_1, length_2;  ///< of the corners
  F dot_01, dot_02, dot_12;
  Vec<F> normal;  ///< edge_1 × edge_2
  F determinant;  ///< of the corners: positive where they run counterclockwise seen from outside
  F solid_angle;
};

template <class F>
inline Triangle<F> triangle_of(const Vec<F>& corner, const Vec<F>& edge_1, const Vec<F>& edge_2) {
  using T = scalar_t<F>;
  const auto largest = [](const Vec<F>& v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); };
  const F size = max(largest(corner), max(largest(edge_1), largest(edge_2)));
  const F unit = F(T(1)) / power_of_two_below(max(size, F(std::numeric_limits<T>::min())));
  Triangle<F> t;
  t.unit = unit;
  t.corner = unit * corner, t.edge_1 = unit * edge_1, t.edge_2 = unit * edge_2;
  const Vec<F> corner_1 = t.corner + t.edge_1, corner_2 = t.corner + t.edge_2;
  t.length_0 = length(t.corner), t.length_1 = length(corner_1), t.length_2 = length(corner_2);
  t.dot_01 = dot(t.corner, corner_1), t.dot_02 = dot(t.corner, corner_2), t.dot_12 = dot(corner_1, corner_2);
  // The products of the nearest corner with the normal cancel least.
  Vec<F> nearest = either(t.length_1 < t.length_0, corner_1, t.corner);
  nearest = either(t.length_2 < min(t.length_0, t.length_1), corner_2, nearest);
  t.normal = cross(t.edge_1, t.edge_2), t.determinant = dot(nearest, t.normal);
  const F below = fma(t.length_0 * t.length_1, t.length_2,
                      fma(t.dot_01, t.length_2, fma(t.dot_02, t.length_1, t.dot_12 * t.length_0)));
  t.solid_angle = select(t.determinant == F(T(0)), F(T(0)), F(T(2)) * arctan2(abs(t.determinant), below));
  return t;
}

/// The point of the triangle's plane to which one turns from c₁, by an angle given by the tangent of its half, in the
/// plane that cuts off u₁ of the solid angle (see sample_triangle_solid_angle); `half` are S and C.
template <class F>
inline Vec<F> along_meridian(const Triangle<F>& t, const SinCos<F>& half, const Vec<F>& normal_01, const F& side_of_0,
                             const F& cos_of_0, const F& tan_part, const F& distance_by_sines) {
  using T = scalar_t<F>;
  const F one(T(1)), tiny(std::numeric_limits<T>::min());
  const Vec<F> corner_1 = t.corner + t.edge_1;
  const F lengths_01 = t.length_0 * t.length_1;
  // Both over S, which for a triangle seen almost edge-on is small together with the sine at c₀.
  const F relative = side_of_0 / max(half.sin, max(F(T(1e-17)) * side_of_0, tiny));
  const F versine = F(T(0.5)) * (lengths_01 - t.dot_01) / lengths_01;  // sin²(c/2)
  const F azimuth_sin = fma(side_of_0, half.cos, -(cos_of_0 * half.sin));
  const F azimuth_cos = fma(relative, versine, -fma(side_of_0, half.sin, half.cos * cos_of_0));
  const F towards = select(t.determinant > F(T(0)), azimuth_sin, -azimuth_sin) / t.length_1;
  const Vec<F> normal_of_arc = towards * cross(corner_1, normal_01) - azimuth_cos * normal_01;
  const Vec<F> ray = spherical::turned(corner_1, t.length_1, normal_of_arc, length(normal_of_arc), tan_part, one);
  // To the plane; along it, to roundings, the law of sines at least has the order of the distance.
  const F slope = dot(t.normal, ray), least = F(T(16) * std::numeric_limits<T>::epsilon()) * length(t.normal);
  const F farthest = max(t.length_0, max(t.length_1, t.length_2));
  const F distance = min(select(abs(slope) > least, abs(t.determinant / slope), distance_by_sines), farthest);
  return distance * ray;
}

}  // namespace spherical

/// The solid angle in sr, in [0, 2π), of the triangle with corners c, c + edge_1 and c + edge_2, seen from the origin,
/// whichever way it turns: tan(Ω/2) = det / (l₀l₁l₂ + …) (A. van Oosterom and J. Strackee, "The Solid Angle of a Plane
/// Triangle", 1983), with the determinant from the edges, in any unit of length.
template <class F>
inline F triangle_solid_angle(const Vec<F>& corner, const Vec<F>& edge_1, const Vec<F>& edge_2) {
  return spherical::triangle_of(corner, edge_1, edge_2).solid_angle;
}

/// A point of that triangle, its direction uniform in solid angle, for u₁ and u₂ in [0, 1): J. Arvo's map ("Stratified
/// Sampling of Spherical Triangles", 1995) without an angle that loses its digits.
///
/// u₁ cuts off the triangle (c₀, c₁, e) with a share u₁ of the solid angle, e on the edge from c₀ to c₂: with σ the
/// angle from c₀ to e, S and C the sine and cosine of u₁Ω/2, and the formula above solved for tan(σ/2),
///   tan(σ/2) = S (l₀l₁ + c₀·c₁) |c₀×c₂| / (C l₀ det − S (c₀×c₁)·(c₀×c₂)).
/// u₂ is the share of the cap about c₁, seen under ρ = ∠(c₁, e), that is nearer to it: sin²(r/2) = u₂ sin²(ρ/2), so
/// tan(r/2) = √u₂ tan(ρ/2) / √(1 + (1 − u₂) tan²(ρ/2)).
///
/// Barycentric weights say where that is to a few roundings of the triangle's size. Where a side is seen under more
/// than a right angle that is coarse beside the distance, and the meridian of c₁ may turn by far while e hardly moves;
/// so the direction is turned to from c₁, in the plane at the angle φ from c₀, by Girard's formula for α + φ + ∠e − π =
/// u₁Ω:
///   tan φ = S sin(α − u₁Ω/2) / (sin α sin²(c/2) − S cos(α − u₁Ω/2)), α the angle at c₀ and c = ∠(c₀, c₁).
template <class F>
inline TrianglePoint<F> sample_triangle_solid_angle(const Vec<F>& corner, const Vec<F>& edge_1, const Vec<F>& edge_2,
                                                    const F& u1, const F& u2) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1)), tiny(std::numeric_limits<T>::min());
  const spherical::Triangle<F> t = spherical::triangle_of(corner, edge_1, edge_2);
  const Vec<F> normal_01 = cross(t.corner, t.edge_1), normal_02 = cross(t.corner, t.edge_2);
  const F sine_01 = length(normal_01), sine_02 = length(normal_02);
  const F lengths_01 = t.length_0 * t.length_1;
  const auto half = sin_cos(u1 * (F(T(0.5)) * t.solid_angle));
  // l₀l₁ + c₀·c₁, where the corners are almost opposite by the other form.
  const F sum_01 =
      select(t.dot_01 >= zero, lengths_01 + t.dot_01, sine_01 * (sine_01 / max(lengths_01 - t.dot_01, tiny)));
  const F above = half.sin * sum_01 * sine_02;
  const F side_of_0 = t.length_0 * abs(t.determinant), cos_of_0 = dot(normal_01, normal_02);  // of the angle at c₀
  const F below = fma(half.cos, side_of_0, -(half.sin * cos_of_0));
  const F tan_all = spherical::tan_half_angle(sine_02, t.dot_02, t.length_0 * t.length_2);
  const F tan_covered = select(below > zero, above / max(below, tiny), select(above > zero, tan_all, zero));
  const spherical::EdgePoint<F> end = spherical::point_of_edge(t.length_0, t.length_2, sine_02, tan_covered, tan_all);

  const Vec<F> corner_1 = t.corner + t.edge_1, corner_2 = t.corner + t.edge_2;
  const auto wide = min(t.dot_01, min(t.dot_02, t.dot_12)) < zero;
  Vec<F> e = end.to_0 * t.corner + end.to_1 * corner_2, across = end.to_1 * t.edge_2 - t.edge_1;  // across from c₁ to e
  if (any_lane(wide)) {
    const Vec<F> turned =
        spherical::turned(t.corner, t.length_0, normal_02, sine_02, min(tan_covered, tan_all), end.distance);
    e = spherical::either(wide, turned, e), across = spherical::either(wide, e - corner_1, across);
  }
  const Vec<F> normal_1e = cross(corner_1, across);
  const F sine_1e = length(normal_1e);
  const F tan_arc = spherical::tan_half_angle(sine_1e, dot(corner_1, e), t.length_1 * end.distance);
  const F tan_part = min(sqrt(u2) * tan_arc / sqrt(fma((one - u2) * tan_arc, tan_arc, one)), tan_arc);
  const spherical::EdgePoint<F> point = spherical::point_of_edge(t.length_1, end.distance, sine_1e, tan_part, tan_arc);

  F b0 = point.to_1 * end.to_0, b1 = point.to_0, b2 = point.to_1 * end.to_1;
  Vec<F> position = b0 * t.corner + b1 * corner_1 + b2 * corner_2;
  if (any_lane(wide)) {
    const Vec<F> turned = spherical::along_meridian(t, half, normal_01, side_of_0, cos_of_0, tan_part, point.distance);
    position = spherical::either(wide, turned, position);
    const Vec<F> from_0 = position - t.corner, weight = (one / dot(t.normal, t.normal)) * t.normal;
    const F to_1 = dot(cross(from_0, t.edge_2), weight), to_2 = dot(cross(t.edge_1, from_0), weight);
    const F toward_1 = min(max(to_1, zero), one), toward_2 = min(max(to_2, zero), one - toward_1);
    // What roundings put outside is brought back to the edge.
    const auto outside = wide & ((to_1 != toward_1) | (to_2 != toward_2));
    position = spherical::either(outside, t.corner + toward_1 * t.edge_1 + toward_2 * t.edge_2, position);
    b1 = select(wide, toward_1, b1), b2 = select(wide, toward_2, b2);
    b0 = select(wide, one - toward_1 - toward_2, b0);
  }
  const auto seen = t.solid_angle > zero;
  const F third(T(1) / T(3));
  const Vec<F> middle = t.corner + third * (t.edge_1 + t.edge_2);
  return {(one / t.unit) * spherical::either(seen, position, middle), select(seen, b0, third), select(seen, b1, third),
          select(seen, b2, third), t.solid_angle};
}

}  // namespace halfslope
