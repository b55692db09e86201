#include "scenes/emitters.h"

#include <cmath>
#include <numbers>

namespace halfslope {
namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

// ∫ 2π sin θ f(θ) dθ with f = 1 up to the beam's width b and (c − θ)/(c − b) from there to the cutoff c: by parts,
// 2π (1 − (sin c − sin b)/(c − b)).
double solid_angle(const SpotLight& spot) {
  const double b = spot.beam_width, c = spot.cutoff_angle;
  const double mean_cos = c > b ? (std::sin(c) - std::sin(b)) / (c - b) : std::cos(c);
  return 2 * kPi * (1 - mean_cos);
}

// Between rows radiance is linear in the polar angle θ, so a row at θ_j counts ∫ hat_j(θ) sin θ dθ: with steps of h,
// 2 sin θ_j (1 − cos h)/h, and 1 − sin h/h at the poles.
Rgb mean_radiance(const Environment& environment) {
  if (!environment.map) return environment.radiance;
  const Bitmap& map = *environment.map;
  const double h = kPi / (map.height - 1), half = std::sin(h / 2);
  Rgb mean = Rgb::Zero();
  for (int y = 0; y < map.height; ++y) {
    const bool pole = y == 0 || y == map.height - 1;
    const double weight = pole ? 1 - std::sin(h) / h : 4 * std::sin(y * h) * half * half / h;
    const float* row = map.rgb.data() + 3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width);
    Rgb sum = Rgb::Zero();
    for (int x = 0; x < map.width; ++x) sum += Rgb(row[3 * x], row[3 * x + 1], row[3 * x + 2]);
    mean += weight / (2 * map.width) * sum;
  }
  return environment.scale * mean;
}

}  // namespace halfslope
