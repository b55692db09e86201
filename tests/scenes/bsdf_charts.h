// Coordinates (a, b) in [0, 1)² of directions, in which a BSDF's density is smooth however narrow its lobe: grids over
// them resolve every roughness. They go through the microfacet normal's slope r (cos φ, sin φ), φ from w_o's azimuth.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/vec.h"

namespace halfslope {

struct ChartPoint {
  Vec<double> wi;
  double solid_angle;  ///< per da db; 0 outside the chart
};
struct ChartCoordinates {
  double a, b;
};

namespace charts {

inline Vec<double> upright(const Vec<double>& wo, const Vec<double>& v) { return {v.x, v.y, wo.z > 0 ? v.z : -v.z}; }

inline Vec<double> normal_of_slope(double r, double azimuth) {
  return normalise(Vec<double>{r * std::cos(azimuth), r * std::sin(azimuth), 1});
}
inline double turn(double azimuth) {
  const double turns = azimuth / (2 * std::numbers::pi);
  return std::min(turns - std::floor(turns), 1 - 0x1p-53);
}

}  // namespace charts

/// All directions on w_o's side. a is logarithmic beyond the scale `alpha`, up to the slope that mirrors w_o to the
/// horizon: in the plane of slopes that is a circle of radius 1/cos θ about (tan θ, 0).
class ReflectionChart {
 public:
  ReflectionChart(double alpha, const Vec<double>& wo)
      : alpha_(alpha),
        wo_(wo),
        o_(charts::upright(wo, wo)),
        azimuth_(std::atan2(wo.y, wo.x)),
        tangent_(std::hypot(wo.x, wo.y) / o_.z) {}

  ChartPoint point(double a, double b) const {
    constexpr double kPi = std::numbers::pi;
    const double phi = 2 * kPi * b, range = log_range(phi);
    const double r = alpha_ * std::sqrt(std::expm1(a * range));
    const Vec<double> m = charts::normal_of_slope(r, phi + azimuth_), wi = 2 * dot(o_, m) * m - o_;
    if (!(wi.z > 0)) return {wi, 0};  // at the edge, by rounding
    // dω_i = 4 (w_o·m) dω_m, dω_m = cos³θ_m r dr dφ.
    const double r_dr = 0.5 * alpha_ * alpha_ * range * std::exp(a * range);
    return {charts::upright(wo_, wi), 4 * dot(o_, m) * m.z * m.z * m.z * r_dr * 2 * kPi};
  }
  ChartCoordinates coordinates(const Vec<double>& wi) const {
    const Vec<double> h = o_ + charts::upright(wo_, wi);
    const double phi = std::atan2(h.y, h.x) - azimuth_, slope = std::hypot(h.x, h.y) / (h.z * alpha_);
    return {std::log1p(slope * slope) / log_range(phi), charts::turn(phi)};
  }

 private:
  double log_range(double phi) const {
    const double x = tangent_ * std::cos(phi), root = std::hypot(x, 1),
                 r = (x > 0 ? x + root : 1 / (root - x)) / alpha_;
    return std::log1p(r * r);
  }
  double alpha_;
  Vec<double> wo_, o_;
  double azimuth_, tangent_;
};

/// All directions beyond the surface that some microfacet refracts to w_o, across relative index n. a is
/// logarithmic in m's angle θ_m beyond the scale `alpha`.
class RefractionChart {
 public:
  RefractionChart(double alpha, double index, const Vec<double>& wo)
      : alpha_(alpha),
        index_(index),
        wo_(wo),
        o_(charts::upright(wo, wo)),
        azimuth_(std::atan2(wo.y, wo.x)),
        range_(std::log1p(std::pow(std::numbers::pi / 2 / alpha, 2))) {}

  ChartPoint point(double a, double b) const {
    constexpr double kPi = std::numbers::pi;
    const double theta = alpha_ * std::sqrt(std::expm1(a * range_)), phi = 2 * kPi * b + azimuth_;
    const Vec<double> m{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    const double c = dot(o_, m), sine = std::sqrt(std::max(1 - c * c, 0.0)) / index_;
    if (c <= 0 || sine >= 1) return {o_, 0};
    const double c_t = std::sqrt(1 - sine * sine);
    const Vec<double> wi = (c / index_ - c_t) * m - (1 / index_) * o_;
    if (wi.z >= 0) return {o_, 0};
    // dω_m/dω_i = n² |w_i·m| / (w_o·m + n w_i·m)² (Walter and others 2007, eq. 17).
    const double jacobian = std::pow(c - index_ * c_t, 2) / (index_ * index_ * c_t);
    const double theta_dtheta = 0.5 * alpha_ * alpha_ * range_ * std::exp(a * range_);
    return {charts::upright(wo_, wi), jacobian * std::sin(theta) / theta * theta_dtheta * 2 * kPi};
  }
  ChartCoordinates coordinates(const Vec<double>& wi) const {
    const Vec<double> h = o_ + index_ * charts::upright(wo_, wi);
    const double sign = h.z > 0 ? 1 : -1;
    const double scaled = std::atan2(std::hypot(h.x, h.y), std::fabs(h.z)) / alpha_;
    return {std::log1p(scaled * scaled) / range_, charts::turn(std::atan2(sign * h.y, sign * h.x) - azimuth_)};
  }

 private:
  double alpha_, index_;
  Vec<double> wo_, o_;
  double azimuth_, range_;
};

}  // namespace halfslope
