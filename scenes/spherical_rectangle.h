// The solid angle of a rectangle seen from the origin, and its points drawn uniformly in solid angle (C. Ureña,
// M. Fajardo and A. King, "An Area-Preserving Parametrization for Spherical Rectangles", 2013), by forms that hold from
// the smallest rectangle to a hemisphere, so that neither needs a threshold.
//
// In the rectangle's own axes the receiver is the origin and the rectangle [x₀, x₁] × [y₀, y₁] at height z > 0, turned
// so that x₁ ≥ |x₀| and y₁ ≥ |y₀|. Everything is built from solid angles of pieces whose formulas have positive terms
// only; differences of like numbers are multiplied out.
#pragma once

#include <limits>
#include <numbers>

#include "core/packet.h"
#include "scenes/vec.h"

namespace halfslope {

/// A point of a rectangle: position = corner + a·edge_1 + b·edge_2, relative to the receiver.
template <class F>
struct RectanglePoint {
  Vec<F> position;
  F a, b;         ///< in [0, 1]
  F solid_angle;  ///< of the rectangle, in sr: the density of the direction is its inverse; 0 where seen edge-on
};

namespace spherical {

template <class F>
struct Rectangle {
  F x0, x1, y0, y1, z;  ///< x₁ ≥ |x₀|, y₁ ≥ |y₀|
  F width, height;      ///< x₁ − x₀ and y₁ − y₀, with their own digits
  F unit;               ///< lengths here per length outside
};

/// y₁r₀ − y₀r₁ for r_i² = y_i² + rest², y₁ ≥ |y₀|.
template <class F>
inline F cross_of_ends(const F& y0, const F& y1, const F& r0, const F& r1, const F& height, const F& rest_squared) {
  const F zero(scalar_t<F>(0));
  const F crossed = fma(y1, r0, -(y0 * r1));
  return select(y0 > zero, rest_squared * height * (y1 + y0) / fma(y1, r0, y0 * r1), crossed);
}

/// The solid angle of [0, x] × [y₀, y₁], x ≥ 0, where r_i is the distance of (x, y_i): the difference of its two corner
/// angles arctan(x y_i / (z r_i)).
template <class F>
inline F strip(const F& x, const F& y0, const F& y1, const F& z, const F& r0, const F& r1, const F& height) {
  const F ends = cross_of_ends(y0, y1, r0, r1, height, fma(x, x, z * z));
  return arctan2(x * z * ends, fma(z * r0, z * r1, (x * y0) * (x * y1)));
}

/// The solid angle of [x, ∞) × [y₀, y₁], x ≥ 0: a triangle with one corner at infinity.
template <class F>
inline F beyond(const F& x, const F& y0, const F& y1, const F& z, const F& r0, const F& r1, const F& height) {
  using T = scalar_t<F>;
  const F rest = fma(x, x, z * z), zero(T(0)), products = fma(r0, r1, y0 * y1);
  const F sum = select(y0 < zero, rest * (rest + fma(y0, y0, y1 * y1)) / fma(r0, r1, -(y0 * y1)), products);
  return F(T(2)) * arctan2(z * height, sum + rest + x * (r0 + r1));
}

template <class F>
inline F solid_angle(const Rectangle<F>& q) {
  using T = scalar_t<F>;
  const F zero(T(0)), z2 = q.z * q.z;
  const auto distance = [&](const F& x, const F& y) { return sqrt(fma(x, x, fma(y, y, z2))); };
  const F r00 = distance(q.x0, q.y0), r01 = distance(q.x0, q.y1), r10 = distance(q.x1, q.y0),
          r11 = distance(q.x1, q.y1);
  const auto across_x = q.x0 < zero, across_y = q.y0 < zero;
  // Where the foot of the perpendicular lies beside no side, two strips; else the two triangles, with acute sides.
  const F strips_x =
      strip(q.x1, q.y0, q.y1, q.z, r10, r11, q.height) + strip(abs(q.x0), q.y0, q.y1, q.z, r00, r01, q.height);
  F result = strips_x;
  if (any_lane(!across_x)) {
    const F strips_y =
        strip(q.y1, q.x0, q.x1, q.z, r01, r11, q.width) + strip(abs(q.y0), q.x0, q.x1, q.z, r00, r10, q.width);
    const auto along = [&](const F& xa, const F& ya, const F& xb, const F& yb) { return fma(xa, xb, fma(ya, yb, z2)); };
    const F determinant = q.z * q.width * q.height, diagonal = along(q.x0, q.y0, q.x1, q.y1);
    const auto triangle = [&](const F& x, const F& y, const F& r) {  // (x₀, y₀), (x, y), (x₁, y₁)
      const F below =
          fma(r00 * r, r11, fma(along(q.x0, q.y0, x, y), r11, fma(diagonal, r, along(x, y, q.x1, q.y1) * r00)));
      return F(T(2)) * arctan2(determinant, below);
    };
    const F triangles = triangle(q.x1, q.y0, r10) + triangle(q.x0, q.y1, r01);
    result = select(across_x, strips_x, select(across_y, strips_y, triangles));
  }
  return select(q.z > zero, result, zero);
}

/// A coordinate between two ends, from either of which it may be small: where the ends are farther apart than the
/// receiver is from them, `at` has the digits, else `left` has.
template <class F>
struct Between {
  F left;  ///< in [0, 1]: the share of the way that lies between it and the upper end
  F at;
};

/// The x that leaves the solid angle `left` of the rectangle's between it and x₁.
///
/// With b_i = y_i/√(y_i² + z²) = sin η_i, g_i = cos η_i, Δ = η₁ − η₀: θ(x), the solid angle of [0, x] × [y₀, y₁], is
/// arcsin(c b₁) − arcsin(c b₀) for c = x/√(x² + z²) (Girard), which solved for x is
///   x = z sin θ / √W,  W = (cos θ − b₀b₁)² − (g₀g₁)² = 4 s p s̄ p̄,
/// where s = sin(ε/2), p = cos(η₁ − ε/2), with ε = Δ − θ the solid angle of [x, ∞) × [y₀, y₁], and s̄ = sin(ε̄/2),
/// p̄ = cos(η₁ − ε̄/2) with ε̄ = Δ + θ. Of two x, with θ₁ − θ = left,
///   x₁² − x² = 2 z² sin((θ₁ + θ)/2) sin((θ₁ − θ)/2) (κ κ̌₁ + κ₁ κ̌) / (W W₁),
///   κ = b₁ cos θ − b₀ = g₁ sin θ + 2 s p̄,  κ̌ = b₁ − b₀ cos θ = g₀ sin θ + 2 s p.
template <class F>
inline Between<F> split_x(const Rectangle<F>& q, const F& left) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1)), half(T(0.5)), two(T(2)), right(std::numbers::pi_v<T> / 2),
      tiny(std::numeric_limits<T>::min());
  const F z2 = q.z * q.z, rest = fma(q.x1, q.x1, z2);
  const F r0 = sqrt(fma(q.y0, q.y0, rest)), r1 = sqrt(fma(q.y1, q.y1, rest));
  const F theta_1 = strip(q.x1, q.y0, q.y1, q.z, r0, r1, q.height);
  const F epsilon_1 = beyond(q.x1, q.y0, q.y1, q.z, r0, r1, q.height);
  const F theta = theta_1 - left, epsilon = epsilon_1 + left;
  const F rho_0 = sqrt(fma(q.y0, q.y0, z2)), rho_1 = sqrt(fma(q.y1, q.y1, z2));
  const F b0 = q.y0 / rho_0, b1 = q.y1 / rho_1, g0 = q.z / rho_0, g1 = q.z / rho_1;
  const F sin_delta = g0 * (q.height / rho_1), cos_delta = fma(g0, g1, b0 * b1);
  // The sine of an angle, the rest of Δ given: near π it is taken from that, where Δ is obtuse and all terms positive.
  const auto sine_of = [&](const F& angle, const SinCos<F>& of_angle, const SinCos<F>& of_rest) {
    return select(angle > right, fma(sin_delta, of_rest.cos, -(cos_delta * of_rest.sin)), of_angle.sin);
  };
  struct End {
    F sin_theta, root, kappa, kappa_turned;  // √W, and κ and κ̌ over it: grazing, W leaves binary32
  };
  const auto end = [&](const F& angle, const F& gap) {
    const F near_angle = half * gap, far_angle = max(near_angle + angle, zero);  // ε/2 and ε̄/2
    const auto near = sin_cos(near_angle), far = sin_cos(far_angle);
    const F s = sine_of(near_angle, near, far), s_bar = sine_of(far_angle, far, near);
    const auto before = angle < zero, around = q.y0 < zero;
    const F p = select(before & around, fma(g0, far.cos, -(b0 * s_bar)), fma(g1, near.cos, b1 * s));
    const F p_bar = select(around & !before, fma(g0, near.cos, -(b0 * s)), fma(g1, far.cos, b1 * s_bar));
    const SinCos<F> whole_gap = {two * near.sin * near.cos, one - two * near.sin * near.sin};
    const F size = sine_of(angle, sin_cos(abs(angle)), whole_gap), sine = select(before, -size, size);
    const F root = max(two * sqrt(s * p) * sqrt(s_bar * p_bar), tiny);
    return End{sine, root, fma(g1, sine, two * s * p_bar) / root, fma(g0, sine, two * s * p) / root};
  };
  const End here = end(theta, epsilon), last = end(theta_1, epsilon_1);
  const F x = q.z * here.sin_theta / here.root, x1 = q.z * last.sin_theta / last.root;
  const F mean = max(theta_1 - half * left, zero);
  const F sine_of_mean = sine_of(mean, sin_cos(mean), sin_cos(fma(half, left, epsilon_1)));
  const F product = fma(here.kappa, last.kappa_turned, last.kappa * here.kappa_turned);
  const F squares = two * (q.z * sine_of_mean / last.root) * (q.z * sin_cos(half * left).sin / here.root) * product;
  const F way = select(theta > zero, squares / max(x1 + x, tiny), q.x1 - x);
  const F share = min(max(way / q.width, zero), one);
  return {share, select(q.width > q.z, min(max(x, q.x0), q.x1), fma(-share, q.width, q.x1))};
}

/// The y above which the share v of the solid angle along the arc at x lies. That is as h = y/√(d² + y²) = sin φ,
/// d² = x² + z² (Archimedes), so h = h₁ − v (h₁ − h₀); and y₁ − y = d sin(φ₁ − φ) / (cos φ₁ cos φ).
template <class F>
inline Between<F> split_y(const Rectangle<F>& q, const F& x, const F& v) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1)), tiny(std::numeric_limits<T>::min());
  const F d2 = fma(x, x, q.z * q.z), d = sqrt(d2);
  const F r0 = sqrt(fma(q.y0, q.y0, d2)), r1 = sqrt(fma(q.y1, q.y1, d2));
  const F ends = cross_of_ends(q.y0, q.y1, r0, r1, q.height, d2);
  const F below = v * (ends / r0 / r1), h1 = q.y1 / r1, h = h1 - below, cos_1 = d / r1;
  const F cosine = max(sqrt(fma(cos_1, cos_1, below * max(h1 + h, zero))), tiny);
  const F sine =
      select(h > zero, below * (h1 + h) / max(fma(h1, cosine, h * cos_1), tiny), fma(h1, cosine, -(h * cos_1)));
  const F share = min(max(d * sine / (cos_1 * cosine) / q.height, zero), one);
  return {share, select(q.height > d, min(max(d * h / cosine, q.y0), q.y1), fma(-share, q.height, q.y1))};
}

/// The rectangle in its own axes, with what leads back.
template <class F>
struct PlacedRectangle {
  Vec<F> u, v, normal;    ///< unit length
  F z;                    ///< signed
  mask_t<F> left, under;  ///< where it was mirrored, its middle being left of or below the receiver
  Rectangle<F> own;
};

/// In a unit of length that keeps products of three in range.
template <class F>
inline PlacedRectangle<F> place_rectangle(const Vec<F>& corner, const Vec<F>& edge_1, const Vec<F>& edge_2) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1)), half(T(0.5));
  PlacedRectangle<F> placed;
  const F width = length(edge_1), height = length(edge_2);
  placed.u = (one / width) * edge_1, placed.v = (one / height) * edge_2, placed.normal = cross(placed.u, placed.v);
  const F x = fma(half, width, dot(corner, placed.u)), y = fma(half, height, dot(corner, placed.v));
  placed.z = dot(corner, placed.normal);
  placed.left = x < zero, placed.under = y < zero;
  const F size = max(max(abs(x), abs(y)), max(abs(placed.z), max(width, height)));
  const F unit = one / power_of_two_below(max(size, F(std::numeric_limits<T>::min())));
  const F ax = unit * abs(x), ay = unit * abs(y), wide = unit * width, high = unit * height;
  placed.own = {fma(-half, wide, ax),
                fma(half, wide, ax),
                fma(-half, high, ay),
                fma(half, high, ay),
                unit * abs(placed.z),
                wide,
                high,
                unit};
  return placed;
}

}  // namespace spherical

/// The solid angle in sr, in [0, 2π), of the rectangle with corner c and edges edge_1 ⟂ edge_2, seen from the origin,
/// from whichever side; 0 in its plane.
template <class F>
inline F rectangle_solid_angle(const Vec<F>& corner, const Vec<F>& edge_1, const Vec<F>& edge_2) {
  return spherical::solid_angle(spherical::place_rectangle(corner, edge_1, edge_2).own);
}

/// A point of that rectangle, its direction uniform in solid angle, for u₁ and u₂ in [0, 1): a grows with u₁ and b with
/// u₂. Below 10⁻¹⁷ of its size the map, not the solid angle, is that of this height.
template <class F>
inline RectanglePoint<F> sample_rectangle_solid_angle(const Vec<F>& corner, const Vec<F>& edge_1, const Vec<F>& edge_2,
                                                      const F& u1, const F& u2) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1)), half(T(0.5));
  const auto placed = spherical::place_rectangle(corner, edge_1, edge_2);
  spherical::Rectangle<F> q = placed.own;
  const F all = spherical::solid_angle(q);
  q.z = max(q.z, F(T(1e-17)));
  const auto x = spherical::split_x(q, select(placed.left, u1, one - u1) * all);
  const auto y = spherical::split_y(q, x.at, select(placed.under, u2, one - u2));
  const F to_u = x.at / q.unit, to_v = y.at / q.unit;
  const Vec<F> position = select(placed.left, -to_u, to_u) * placed.u + select(placed.under, -to_v, to_v) * placed.v +
                          placed.z * placed.normal;
  const auto seen = all > zero;
  const auto where = [&](const F& any, const F& edge_on) { return select(seen, any, edge_on); };
  const Vec<F> middle = corner + half * edge_1 + half * edge_2;
  return {{where(position.x, middle.x), where(position.y, middle.y), where(position.z, middle.z)},
          where(select(placed.left, x.left, one - x.left), half),
          where(select(placed.under, y.left, one - y.left), half),
          all};
}

}  // namespace halfslope
