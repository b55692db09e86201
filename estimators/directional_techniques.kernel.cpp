// Direct lighting in directional form: the reflection equation over directions,
//
//   L_o = ∫ f_r(ω_i, ω_o) L_e(y(ω_i)) cos θ_i dω_i,   y the first surface along ω_i,
//
// with directions drawn by the BSDF's own density (technique `bsdf`), uniformly over the hemisphere (`hemisphere`,
// 1/2π) or by the cosine (`cosine`, cos θ/π).
#include "core/coordinates.h"
#include "core/point_block.h"
#include "estimators/kernel_functions.h"
#include "estimators/lighting_rays.h"
#include "scenes/warp.h"

namespace halfslope::kernel {
namespace {

constexpr std::size_t kChunk = 16 * kLanes;  // points converted at a time; their coordinates stay in the first cache

// How each technique draws a direction, and what f_r cos θ / p is for one that meets a light; `pdf_bsdf` is what the
// BSDF's technique would have drawn it with.
struct ByBsdf {
  template <class F, class Bsdf>
  static Vec<F> draw(const Bsdf& bsdf, const F& u_lobe, const F& u1, const F& u2) {
    return bsdf.draw(u_lobe, u1, u2);
  }
  template <class F, class Bsdf>
  static void weigh(const Bsdf& bsdf, const Vec<F>& wi, F* weight, F& pdf_bsdf) {
    bsdf.weigh(wi, weight, pdf_bsdf);
  }
};

struct ByHemisphere {
  template <class F, class Bsdf>
  static Vec<F> draw(const Bsdf&, const F& /*u_lobe*/, const F& u1, const F& u2) {
    return uniform_hemisphere(u1, u2);
  }
  template <class F, class Bsdf>
  static void weigh(const Bsdf& bsdf, const Vec<F>& wi, F* weight, F& pdf_bsdf) {
    using T = scalar_t<F>;
    const Reflection<F> reflection = bsdf.evaluate(wi);
    pdf_bsdf = reflection.pdf;
    const F inverse_pdf(T(2) * std::numbers::pi_v<T>);
    for (int c = 0; c < Bsdf::kChannels; ++c) weight[c] = reflection.cosine_brdf[c] * inverse_pdf;
  }
};

struct ByCosine {
  template <class F, class Bsdf>
  static Vec<F> draw(const Bsdf&, const F& /*u_lobe*/, const F& u1, const F& u2) {
    return cosine_hemisphere(u1, u2);
  }
  template <class F, class Bsdf>
  static void weigh(const Bsdf& bsdf, const Vec<F>& wi, F* weight, F& pdf_bsdf) {
    using T = scalar_t<F>;
    if constexpr (std::is_same_v<Bsdf, Diffuse<F, Bsdf::kChannels>>) {
      bsdf.weigh(wi, weight, pdf_bsdf);  // the same density: the albedo is left, to the last bit
    } else {
      const Reflection<F> reflection = bsdf.evaluate(wi);
      pdf_bsdf = reflection.pdf;
      const F inverse_pdf = F(std::numbers::pi_v<T>) / wi.z;
      for (int c = 0; c < Bsdf::kChannels; ++c) weight[c] = reflection.cosine_brdf[c] * inverse_pdf;
    }
  }
};

template <class Way, class F, class Bsdf>
void directions(const LightingCall<scalar_t<F>>& call, const Bsdf& bsdf) {
  using T = scalar_t<F>;
  constexpr int C = Bsdf::kChannels;
  const PixelData<T>& pixel = *call.pixel;
  const F zero(T(0));
  const bool wants_light = call.pdfs[static_cast<int>(LightingTechnique::kLight)] != nullptr,
             wants_surface = call.pdfs[static_cast<int>(LightingTechnique::kSurface)] != nullptr;
  const bool chooses = call.choose && call.technique == LightingTechnique::kBsdf;
  const int pair = chooses ? 1 : 0;
  alignas(64) T lobe[kChunk] = {}, u1[kChunk], u2[kChunk];
  for (std::size_t begin = 0; begin < call.count; begin += kChunk) {
    const std::size_t size = call.count - begin < kChunk ? call.count - begin : kChunk;
    const auto low = [&](int d) { return call.low[d] ? call.low[d] + begin : nullptr; };
    if (chooses) to_coordinates(call.high[0] + begin, low(0), size, lobe);
    to_coordinates(call.high[pair] + begin, low(pair), size, u1);
    to_coordinates(call.high[pair + 1] + begin, low(pair + 1), size, u2);
    for (std::size_t i = 0; i < size; i += kWidth<F>) {
      LightPoint<F> point;
      point.wi = Way::draw(bsdf, load<F>(lobe + i), load<F>(u1 + i), load<F>(u2 + i));
      point.distance = F(std::numeric_limits<T>::max());
      point.cosine = point.pdf_area = point.pdf_area_surface = zero;
      F light(T(-1)), radiance[3];
      for (int c = 0; c < C; ++c) radiance[c] = zero;
      mask_t<F> seen = zero > zero;
      for (int l = 0; l < pixel.light_count; ++l) {
        const LocalLight<T>& candidate = pixel.lights[l];
        ShapeHit<F> x;
        if (!candidate.reaches || !intersect(candidate.shape, point.wi, x)) continue;
        mask_t<F> first = x.hit & (x.distance < point.distance);
        // A flat light emits from its front, against which the ray must run.
        if (candidate.shape.kind != ShapeKind::kSphere) {
          first = first & (dot(broadcast<F>(candidate.shape.normal), point.wi) < zero);
        }
        point.distance = select(first, x.distance, point.distance);
        light = select(first, F(static_cast<T>(l)), light);
        if (wants_light || wants_surface) point.cosine = select(first, x.cosine, point.cosine);
        if (wants_light) point.pdf_area = select(first, F(candidate.pdf_area), point.pdf_area);
        if (wants_surface)
          point.pdf_area_surface = select(first, F(candidate.pdf_area_surface), point.pdf_area_surface);
        for (int c = 0; c < C; ++c) radiance[c] = select(first, F(candidate.radiance[c]), radiance[c]);
        seen = seen | first;
      }
      seen = seen & (point.wi.z > zero);
      seen = unoccluded(pixel, point.wi, point.distance, light, seen);
      if (!any_lane(seen)) {
        store_nothing<F, C>(call, begin + i);
        continue;
      }
      F weight[3], pdf_bsdf;
      Way::weigh(bsdf, point.wi, weight, pdf_bsdf);
      for (int c = 0; c < C; ++c) store(call.values[c] + begin + i, select(seen, weight[c] * radiance[c], zero));
      store_pdfs<F>(call, begin + i, seen, point, pdf_bsdf);
    }
  }
}

}  // namespace

template <class T>
void sample_direction(const LightingCall<T>& call) {
  using F = NativePacket<T>;
  with_bsdf(*call.pixel, call.channels, [&](const auto& bsdf) {
    switch (call.technique) {
      case LightingTechnique::kHemisphere:
        return directions<ByHemisphere, F>(call, bsdf);
      case LightingTechnique::kCosine:
        return directions<ByCosine, F>(call, bsdf);
      default:
        return directions<ByBsdf, F>(call, bsdf);
    }
  });
}
template void sample_direction<float>(const LightingCall<float>&);
template void sample_direction<double>(const LightingCall<double>&);

}  // namespace halfslope::kernel
