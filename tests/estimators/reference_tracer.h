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

/// f and every technique's density in solid angle; all 0 where the sample is worth nothing.
struct ExpectedTerm {
  Rgb value = Rgb::Zero();               ///< f_r cos θ L_e
  std::array<double, 5> densities = {};  ///< of light, bsdf, hemisphere, cosine and surface
  /// A nudge of `tolerance` changes what is seen: rounding may decide either way.
  bool grazing = false;
  // For a sample of `light` or `surface`: which light (−1: a surface that is none), and where.
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
      total_area_ += area(scene.primitives[i]);
    }
  }

  /// A light chosen by `choice` in [0, 1), each as likely, and a point on it.
  ExpectedTerm light_sample(double choice, double u1, double u2) {
    return point_sample(lights_[static_cast<std::size_t>(choice * static_cast<double>(lights_.size()))], u1, u2);
  }

  /// A surface chosen by its share of all area, lights first, in order; and a point on it.
  ExpectedTerm surface_sample(double choice, double u1, double u2) {
    double end = 0;
    for (const int light : lights_) {
      end += area(scene_.primitives[static_cast<std::size_t>(light)]) / total_area_;
      if (std::abs(choice - end) < 1e-8) {  // the kernels' shares are rounded
        ExpectedTerm term;
        term.grazing = true;
        return term;
      }
      if (choice < end) return point_sample(light, u1, u2);
    }
    return {};
  }

  /// A point uniform on a light's area: on a sphere at height 1 − 2u₁ and azimuth 2πu₂, on a disk at radius √u₁ and
  /// that azimuth.
  ExpectedTerm point_sample(int chosen, double u1, double u2) {
    ExpectedTerm term;
    term.light = chosen;
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
      const double azimuth = 2 * std::numbers::pi * u2;
      term.point = r.outline == Flat::Outline::kDisk
                       ? Vec3(r.center + std::sqrt(u1) * (std::cos(azimuth) * r.half_u + std::sin(azimuth) * r.half_v))
                       : Vec3(r.center + (2 * u1 - 1) * r.half_u + (2 * u2 - 1) * r.half_v);
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
    return term;
  }

  /// Whatever lies in a direction, given in the world.
  ExpectedTerm direction_sample(const Vec3& wi) {
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
    term.light = hit.primitive;
    fill(term, scene_.primitives[static_cast<std::size_t>(hit.primitive)], wi, distance * distance, cos_psi);
    return term;
  }

  const Vec3& position() const { return x_; }
  const Vec3& normal() const { return n_; }
  const Vec3& to_eye() const { return wo_; }
  const Bsdf& bsdf() const { return bsdf_; }
  /// The specular part's share of the albedos' Rec. 709 luminances.
  double specular_share() const {
    const auto luminance = [](const Rgb& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; };
    return luminance(bsdf_.specular) / (luminance(bsdf_.specular) + luminance(bsdf_.reflectance));
  }
  /// How far surface choices, which come in steps of 2⁻³², may be from a light's share of the area, relative to it.
  double choice_rounding(int light) const {
    const double share = area(scene_.primitives[static_cast<std::size_t>(light)]) / total_area_;
    return static_cast<double>(lights_.size()) * 0x1p-32 / share;
  }

 private:
  Vec3 nudge() {
    const auto signed_unit = [&] { return static_cast<double>(random_() >> 11) * 0x1p-52 - 1; };
    const double a = signed_unit(), b = signed_unit(), c = signed_unit();
    return 0.5 * tolerance_ * Vec3(a, b, c);
  }

  static double area(const Primitive& primitive) {
    if (const auto* s = std::get_if<Sphere>(&primitive.shape)) return 4 * std::numbers::pi * s->radius * s->radius;
    const auto& r = std::get<Flat>(primitive.shape);
    const double parallelogram = r.half_u.cross(r.half_v).norm();
    return (r.outline == Flat::Outline::kDisk ? std::numbers::pi : 4) * parallelogram;
  }

  /// value: f_r cos θ L_e.
  void fill(ExpectedTerm& term, const Primitive& light, const Vec3& wi, double distance_squared, double cos_psi) const {
    auto& [pdf_light, pdf_bsdf, pdf_hemisphere, pdf_cosine, pdf_surface] = term.densities;
    const double cos_i = n_.dot(wi);
    pdf_light = distance_squared / (cos_psi * area(light) * static_cast<double>(lights_.size()));
    pdf_surface = distance_squared / (cos_psi * total_area_);
    pdf_hemisphere = 0.5 / std::numbers::pi;
    pdf_cosine = cos_i / std::numbers::pi;
    if (bsdf_.kind == BsdfKind::kPhong) {
      const double lobe = std::pow(std::max(0.0, (2 * n_.dot(wo_) * n_ - wo_).dot(wi)), bsdf_.exponent);
      const double share = specular_share(), n = bsdf_.exponent;
      pdf_bsdf = share * (n + 1) / (2 * std::numbers::pi) * lobe + (1 - share) * pdf_cosine;
      const Rgb brdf =
          bsdf_.reflectance / std::numbers::pi + bsdf_.specular * ((n + 2) / (2 * std::numbers::pi) * lobe);
      term.value = brdf * light.radiance * cos_i;
      return;
    }
    if (bsdf_.kind == BsdfKind::kDiffuse) {
      pdf_bsdf = pdf_cosine;
      term.value = bsdf_.reflectance * light.radiance * (cos_i / std::numbers::pi);
      return;
    }
    const Vec3 h = (wi + wo_).normalized();
    const double cos_o = n_.dot(wo_), a2 = bsdf_.alpha * bsdf_.alpha;
    const double tan2_h = n_.cross(h).squaredNorm() / std::pow(n_.dot(h), 2);
    const double d = 1 / (std::numbers::pi * a2 * std::pow(n_.dot(h), 4) * std::pow(1 + tan2_h / a2, 2));
    const auto lambda = [&](double c) { return (std::sqrt(1 + a2 * (1 / (c * c) - 1)) - 1) / 2; };
    pdf_bsdf = d / (1 + lambda(cos_o)) / (4 * cos_o);
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
  double total_area_ = 0;
  std::mt19937_64 random_{12345};
};

}  // namespace halfslope
