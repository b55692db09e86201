// What a sample of direct light is worth, in double precision: nearest hits of the whole scene for visibility, textbook
// formulas for BSDFs and densities. Shares the mapping from numbers to samples with the kernels, and nothing else.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <variant>
#include <vector>

#include "estimators/occlusion.h"
#include "scenes/scene.h"

namespace halfslope {

/// f/p and both densities in solid angle; all 0 where the sample is worth nothing.
struct ExpectedTerm {
  Rgb value = Rgb::Zero();
  double pdf_light = 0, pdf_bsdf = 0;
  /// A nudge of `tolerance` changes what is seen: rounding may decide either way.
  bool grazing = false;
  // For a light sample: which light, and where.
  int light = -1;
  Vec3 point = Vec3::Zero();
  bool faces = false;  ///< both cosines are positive, whatever is between
};

class ReferenceTracer {
 public:
  /// `tolerance` is relative to lengths of about 1.
  ReferenceTracer(const Scene& scene, const Hit& seen, const Vec3& to_eye, double tolerance)
      : scene_(scene),
        receiver_(seen.primitive),
        x_(seen.position),
        n_(seen.normal),
        wo_(to_eye),
        tolerance_(tolerance) {
    bsdf_ = scene.primitives[static_cast<std::size_t>(seen.primitive)].bsdf;
    for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
      if (scene.primitives[i].emits) lights_.push_back(static_cast<int>(i));
    }
  }

  /// A light chosen by `choice` in [0, 1), a point uniform on its area: on a sphere at height 1 − 2u₁ and azimuth 2πu₂.
  ExpectedTerm light_sample(double choice, double u1, double u2) {
    ExpectedTerm term;
    term.light = lights_[static_cast<std::size_t>(choice * static_cast<double>(lights_.size()))];
    const Primitive& light = scene_.primitives[static_cast<std::size_t>(term.light)];
    Vec3 normal;
    if (const auto* s = std::get_if<Sphere>(&light.shape)) {
      const double height = 1 - 2 * u1, ring = std::sqrt(1 - height * height), azimuth = 2 * std::numbers::pi * u2;
      const Vec3 outward(ring * std::cos(azimuth), ring * std::sin(azimuth), height);
      term.point = s->center + s->radius * outward;
      normal = s->flip_normals ? Vec3(-outward) : outward;
    } else {
      const auto& r = std::get<Flat>(light.shape);
      if (term.light == receiver_) return term;  // lies in its own plane
      term.point = r.center + (2 * u1 - 1) * r.half_u + (2 * u2 - 1) * r.half_v;
      normal = r.normal;
    }
    const Vec3 wi = (term.point - x_).normalized();
    const double cos_theta = n_.dot(wi), cos_psi = -normal.dot(wi);
    term.grazing = std::abs(cos_theta) < 100 * tolerance_ || std::abs(cos_psi) < 100 * tolerance_ ||
                   (term.point - x_).norm() < 1e3 * tolerance_;
    term.faces = cos_theta > 0 && cos_psi > 0;
    if (!term.faces || term.grazing) return term;
    const auto visible = [&](const Vec3& from, const Vec3& to) {
      const Hit hit = first_hit(scene_, {from, (to - from).normalized()});
      return hit.primitive == term.light && hit.front;
    };
    const bool seen = visible(x_ + tolerance_ * wi, term.point);
    for (int i = 0; i < 4; ++i) {
      const Vec3 from = x_ + tolerance_ * n_ + nudge(), to = term.point + nudge();
      term.grazing = term.grazing || visible(from, to) != seen;
    }
    if (!seen) return term;
    fill(term, light, wi, (term.point - x_).squaredNorm(), cos_psi);
    term.value *= 1 / term.pdf_light;
    return term;
  }

  /// The direction of a BSDF sample, given in the world.
  ExpectedTerm bsdf_sample(const Vec3& wi) {
    ExpectedTerm term;
    term.grazing = std::abs(n_.dot(wi)) < 100 * tolerance_;
    if (n_.dot(wi) <= 0 || term.grazing) return term;
    const auto seen = [&](const Vec3& from, const Vec3& direction) {
      Hit hit = first_hit(scene_, {from, direction.normalized()});
      if (hit.primitive >= 0 && !(hit.front && scene_.primitives[static_cast<std::size_t>(hit.primitive)].emits)) {
        hit.primitive = -1;
      }
      return hit;
    };
    const Hit hit = seen(x_ + tolerance_ * wi, wi);  // on the ray itself, off the surface
    for (int i = 0; i < 4; ++i) {
      const Vec3 from = x_ + tolerance_ * n_ + nudge(), direction = wi + nudge();
      term.grazing = term.grazing || seen(from, direction).primitive != hit.primitive;
    }
    if (hit.primitive < 0) return term;
    const double distance = hit.distance + tolerance_, cos_psi = -hit.normal.dot(wi);
    term.grazing = term.grazing || cos_psi < 100 * tolerance_ || distance < 1e3 * tolerance_;
    fill(term, scene_.primitives[static_cast<std::size_t>(hit.primitive)], wi, distance * distance, cos_psi);
    term.value *= 1 / term.pdf_bsdf;
    return term;
  }

  const Vec3& position() const { return x_; }
  const Vec3& normal() const { return n_; }
  const Vec3& to_eye() const { return wo_; }
  const Bsdf& bsdf() const { return bsdf_; }
  std::size_t light_count() const { return lights_.size(); }

 private:
  Vec3 nudge() {
    const auto signed_unit = [&] { return static_cast<double>(random_() >> 11) * 0x1p-52 - 1; };
    const double a = signed_unit(), b = signed_unit(), c = signed_unit();
    return 0.5 * tolerance_ * Vec3(a, b, c);
  }

  static double area(const Primitive& primitive) {
    if (const auto* s = std::get_if<Sphere>(&primitive.shape)) return 4 * std::numbers::pi * s->radius * s->radius;
    const auto& r = std::get<Flat>(primitive.shape);
    return (2 * r.half_u).cross(2 * r.half_v).norm();
  }

  /// value: f_r cos θ L_e.
  void fill(ExpectedTerm& term, const Primitive& light, const Vec3& wi, double distance_squared, double cos_psi) const {
    term.pdf_light = distance_squared / (cos_psi * area(light) * static_cast<double>(lights_.size()));
    const double cos_i = n_.dot(wi);
    if (bsdf_.kind == BsdfKind::kDiffuse) {
      term.pdf_bsdf = cos_i / std::numbers::pi;
      term.value = bsdf_.reflectance * light.radiance * (cos_i / std::numbers::pi);
      return;
    }
    const Vec3 h = (wi + wo_).normalized();
    const double cos_o = n_.dot(wo_), a2 = bsdf_.alpha * bsdf_.alpha;
    const double tan2_h = n_.cross(h).squaredNorm() / std::pow(n_.dot(h), 2);
    const double d = 1 / (std::numbers::pi * a2 * std::pow(n_.dot(h), 4) * std::pow(1 + tan2_h / a2, 2));
    const auto lambda = [&](double c) { return (std::sqrt(1 + a2 * (1 / (c * c) - 1)) - 1) / 2; };
    term.pdf_bsdf = d / (1 + lambda(cos_o)) / (4 * cos_o);
    const double specular = d / (1 + lambda(cos_i) + lambda(cos_o)) / (4 * cos_o);
    for (int c = 0; c < 3; ++c) {
      const double f = bsdf_.unit_fresnel ? 1 : fresnel(wi.dot(h), {bsdf_.eta[c], bsdf_.k[c]});
      term.value[c] = bsdf_.reflectance[c] * light.radiance[c] * f * specular;
    }
  }

  static double fresnel(double c, std::complex<double> index) {
    const std::complex<double> cos_t = std::sqrt(1.0 - (1 - c * c) / (index * index));
    return (std::norm((c - index * cos_t) / (c + index * cos_t)) +
            std::norm((index * c - cos_t) / (index * c + cos_t))) /
           2;
  }

  const Scene& scene_;
  int receiver_;
  Vec3 x_, n_, wo_;
  double tolerance_;
  Bsdf bsdf_;
  std::vector<int> lights_;
  std::mt19937_64 random_{12345};
};

}  // namespace halfslope
