// Every BSDF as kernels evaluate it, and which class a material takes. To add one: its kind in scenes/bsdf_kind.h, its
// class beside these (scenes/bsdf_values.h says what it must have), and a line below.
#pragma once

#include <type_traits>

#include "scenes/conductor_bsdf.h"
#include "scenes/dielectric_bsdf.h"
#include "scenes/diffuse_bsdf.h"
#include "scenes/phong_bsdf.h"
#include "scenes/plastic_bsdf.h"
#include "scenes/rough_dielectric_bsdf.h"

namespace halfslope {

/// Calls run(std::type_identity<Class>) with the BSDF class, over F and C channels, of a material of that kind and
/// distribution. Lanes of one packet must agree on it.
template <class F, int C, class Run>
inline auto with_bsdf_class(BsdfKind kind, Distribution distribution, const Run& run) {
  const bool ggx = distribution == Distribution::kGgx;
  switch (kind) {
    case BsdfKind::kRoughConductor:
      return ggx ? run(std::type_identity<GgxConductorBsdf<F, C>>{})
                 : run(std::type_identity<BeckmannConductorBsdf<F, C>>{});
    case BsdfKind::kPhong:
      return run(std::type_identity<PhongBsdf<F, C>>{});
    case BsdfKind::kConductor:
      return run(std::type_identity<ConductorBsdf<F, C>>{});
    case BsdfKind::kPlastic:
      return run(std::type_identity<PlasticBsdf<F, C>>{});
    case BsdfKind::kRoughPlastic:
      return ggx ? run(std::type_identity<GgxPlasticBsdf<F, C>>{})
                 : run(std::type_identity<BeckmannPlasticBsdf<F, C>>{});
    case BsdfKind::kDielectric:
      return run(std::type_identity<DielectricBsdf<F, C>>{});
    case BsdfKind::kRoughDielectric:
      return ggx ? run(std::type_identity<GgxDielectricBsdf<F, C>>{})
                 : run(std::type_identity<BeckmannDielectricBsdf<F, C>>{});
    case BsdfKind::kDiffuse:
      break;
  }
  return run(std::type_identity<DiffuseBsdf<F, C>>{});
}

}  // namespace halfslope
