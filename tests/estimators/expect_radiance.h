// Direct light against a known radiance: every technique and combination, in both precisions.
#pragma once

#include <string>
#include <vector>

#include "tests/estimators/estimates.h"
#include "tests/estimators/scene_builder.h"

namespace halfslope {

/// Estimators of direct light; each row draws the same samples.
inline const std::vector<std::vector<std::string>>& every_estimator() {
  static const std::vector<std::vector<std::string>> kRows = {
      {"light"},
      {"bsdf"},
      {"hemisphere"},
      {"cosine"},
      {"surface"},
      {"average", "balance", "power", "power:1.5", "cutoff:0.1", "maximum"},
      {"balance@light*2+bsdf+hemisphere+cosine+surface", "cutoff:0.5@light*2+bsdf+hemisphere+cosine+surface"},
      {"power@hemisphere+surface", "maximum@hemisphere+surface"}};
  return kRows;
}

/// Every estimator and precision at a pixel, within t⁻¹(1 − 5e-7) standard errors of 64 replicates and `slack_f64`,
/// `slack_f32` (relative) for rounding. The sampler's points are uniform each and its replicates independent, which is
/// all that is asked of them; stratification makes the comparison narrow.
inline void expect_radiance(const DirectLighting& source, int pixel, const Rgb& exact, const std::string& what,
                            std::uint64_t rounds, double slack_f64 = 1e-11, double slack_f32 = 4e-6) {
  const Request request = {.estimator = "", .sampler = "halton-owen", .rounds = rounds, .seed = 11};
  for (const auto& row : every_estimator()) {
    const auto f64 = estimate_together<double>(source, pixel, row, request),
               f32 = estimate_together<float>(source, pixel, row, request);
    for (std::size_t h = 0; h < row.size(); ++h) {
      for (int c = 0; c < source.channels(); ++c) {
        const auto channel = static_cast<std::size_t>(c);
        const std::string where = what + ' ' + row[h] + " channel " + std::to_string(c);
        expect_mean(f64[h][channel], exact[c], slack_f64, where + " f64");
        expect_mean(f32[h][channel], exact[c], slack_f32, where + " f32");
      }
    }
  }
}

inline void expect_radiance(const Scene& scene, const Rgb& exact, const std::string& what,
                            std::uint64_t rounds = 1024) {
  expect_radiance(lighting(scene), 0, exact, what, rounds);
}

/// A small floor at z = 0, seen at the origin from close by. It is small beside the lights, so that technique `surface`
/// meets those often.
inline Scene floor_under(std::vector<Primitive> others, const Bsdf& bsdf) {
  others.insert(others.begin(), made_of(rectangle(Vec3::Zero(), 0.1 * Vec3::UnitX(), 0.1 * Vec3::UnitY()), bsdf));
  return scene_of(std::move(others), {looking({0.003, 0.004, 0.01}, Vec3::Zero())});
}

/// A rectangle at height c over [0, a] × [0, b], facing down.
inline Primitive ceiling_light(double a, double b, double c, const Rgb& radiance) {
  return emitting(rectangle({a / 2, b / 2, c}, b / 2 * Vec3::UnitY(), a / 2 * Vec3::UnitX()), radiance);
}

}  // namespace halfslope
