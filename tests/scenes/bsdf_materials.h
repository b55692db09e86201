// BSDFs under test: as data, and as their classes over one number type.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "scenes/bsdf.h"
#include "scenes/bsdf_classes.h"

namespace halfslope {

/// What a BSDF class is constructed from: one material for all lanes.
template <class F>
struct UniformMaterial {
  using T = scalar_t<F>;
  const MaterialData<T>& data;
  F operator()(T MaterialData<T>::*field) const { return F(data.*field); }
  template <std::size_t N, std::size_t C>
  void operator()(T (MaterialData<T>::*field)[N], F (&out)[C]) const {
    for (std::size_t c = 0; c < C; ++c) out[c] = F((data.*field)[c]);
  }
};

/// Any BSDF class of one channel behind one type, for tests alone: a kernel has no virtual calls.
template <class F>
struct AnyBsdf {
  virtual ~AnyBsdf() = default;
  virtual BsdfValue<F, 1> evaluate(const Vec<F>& wo, const Vec<F>& wi) const = 0;
  virtual BsdfSample<F, 1> sample(const Vec<F>& wo, const F& u_lobe, const F& u1, const F& u2) const = 0;
  bool chooses = false, continuous = false;
};

template <class F>
std::unique_ptr<AnyBsdf<F>> bsdf_of(const MaterialData<scalar_t<F>>& data) {
  return with_bsdf_class<F, 1>(data.kind, data.distribution, [&](auto type) -> std::unique_ptr<AnyBsdf<F>> {
    using Class = typename decltype(type)::type;
    struct Held : AnyBsdf<F> {
      explicit Held(const MaterialData<scalar_t<F>>& material) : bsdf(UniformMaterial<F>{material}) {
        this->chooses = Class::kChooses;
        this->continuous = Class::kContinuous;
      }
      BsdfValue<F, 1> evaluate(const Vec<F>& wo, const Vec<F>& wi) const override { return bsdf.evaluate(wo, wi); }
      BsdfSample<F, 1> sample(const Vec<F>& wo, const F& u_lobe, const F& u1, const F& u2) const override {
        return bsdf.sample(wo, u_lobe, u1, u2);
      }
      Class bsdf;
    };
    return std::make_unique<Held>(data);
  });
}
template <class F>
std::unique_ptr<AnyBsdf<F>> bsdf_of(const Bsdf& bsdf) {
  return bsdf_of<F>(material_data<scalar_t<F>>(bsdf));
}

struct NamedBsdf {
  std::string name;
  Bsdf bsdf;
  friend std::ostream& operator<<(std::ostream& out, const NamedBsdf& named) { return out << named.name; }
};

inline Bsdf white(BsdfKind kind) {
  Bsdf bsdf;
  bsdf.kind = kind;
  bsdf.reflectance = bsdf.specular = bsdf.transmittance = Rgb::Ones();
  return bsdf;
}
inline Bsdf rough(BsdfKind kind, Distribution distribution, double alpha) {
  Bsdf bsdf = white(kind);
  bsdf.distribution = distribution;
  bsdf.alpha = alpha;
  return bsdf;
}

inline std::string name_of(BsdfKind kind, Distribution distribution, double alpha) {
  const char* kinds[] = {"diffuse", "roughconductor", "phong",      "conductor",
                         "plastic", "roughplastic",   "dielectric", "roughdielectric"};
  return std::string(kinds[static_cast<int>(kind)]) + (distribution == Distribution::kGgx ? " ggx " : " beckmann ") +
         std::to_string(alpha);
}

/// The rough kinds with unit colours, at each roughness.
inline std::vector<NamedBsdf> rough_bsdfs(const std::vector<double>& alphas) {
  std::vector<NamedBsdf> all;
  for (const BsdfKind kind : {BsdfKind::kRoughConductor, BsdfKind::kRoughPlastic, BsdfKind::kRoughDielectric}) {
    for (const Distribution distribution : {Distribution::kGgx, Distribution::kBeckmann}) {
      for (const double alpha : alphas) {
        all.push_back({name_of(kind, distribution, alpha), rough(kind, distribution, alpha)});
      }
    }
  }
  return all;
}
/// The others, with unit colours; a Phong lobe's two parts are 0.3 and 0.7.
inline std::vector<NamedBsdf> smooth_bsdfs() {
  std::vector<NamedBsdf> all;
  for (const BsdfKind kind : {BsdfKind::kDiffuse, BsdfKind::kConductor, BsdfKind::kPlastic, BsdfKind::kDielectric}) {
    all.push_back({name_of(kind, Distribution::kGgx, 0), white(kind)});
  }
  all.push_back({"plastic, nonlinear", white(BsdfKind::kPlastic)});
  all.back().bsdf.nonlinear = true;
  all.push_back({"denser outside", white(BsdfKind::kDielectric)});
  all.back().bsdf.ior = 0.7;
  for (const double exponent : {0.0, 3.0, 100.0, 1e4}) {
    Bsdf bsdf = white(BsdfKind::kPhong);
    bsdf.reflectance = Rgb::Constant(0.3);
    bsdf.specular = Rgb::Constant(0.7);
    bsdf.exponent = exponent;
    all.push_back({"phong " + std::to_string(exponent), bsdf});
  }
  return all;
}
inline std::vector<NamedBsdf> all_bsdfs(const std::vector<double>& alphas) {
  std::vector<NamedBsdf> all = rough_bsdfs(alphas);
  for (NamedBsdf& one : smooth_bsdfs()) all.push_back(std::move(one));
  return all;
}

inline bool transmits(BsdfKind kind) { return kind == BsdfKind::kDielectric || kind == BsdfKind::kRoughDielectric; }

/// Unit length, from its cosine, in [−1, 1], and azimuth.
template <class T = double>
Vec<T> at_cosine(double cosine, double azimuth = 0.7) {
  const double sine = std::sqrt((1 - cosine) * (1 + cosine));
  return {static_cast<T>(sine * std::cos(azimuth)), static_cast<T>(sine * std::sin(azimuth)), static_cast<T>(cosine)};
}

/// Uniform numbers in T's own steps.
template <class T>
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : random_(seed) {}
  T operator()() {
    if constexpr (std::is_same_v<T, float>) return static_cast<float>(random_() >> 40) * 0x1p-24f;
    return static_cast<T>(static_cast<double>(random_() >> 11) * 0x1p-53);
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace halfslope
