#include "estimators/reflected_light.h"

#include <algorithm>

#include "core/kernel_library.h"
#include "estimators/kernels.h"

namespace halfslope {
namespace {

constexpr int kMostDims = 3;

/// The dimensions and arrays that one call of a technique reads and writes.
template <class T, int kTechniques>
struct Arrays {
  const std::uint32_t *high[kMostDims] = {}, *low[kMostDims] = {};
  T* values[3] = {};
  T* pdfs[kTechniques] = {};

  Arrays(const LightingSource& source, const TechniqueCall& call, const PointBlock& points, TermBlock<T>& terms) {
    const int dims = source.techniques[static_cast<std::size_t>(call.technique)].layout.dims();
    for (int d = 0; d < dims; ++d) {
      high[d] = points.high(call.first_dim + d);
      low[d] = points.low(call.first_dim + d);
    }
    for (int c = 0; c < source.channels; ++c) values[c] = terms.value(call.slot, c);
    for (std::size_t k = 0; k < call.set.size(); ++k) {
      pdfs[static_cast<int>(source.meanings[static_cast<std::size_t>(call.set[k])])] =
          terms.pdf(call.slot, static_cast<int>(k));
    }
  }
  bool chooses() const { return high[2] != nullptr; }
};

/// A point is sampled in one precision, and what that needs is made when it is first asked for; an integral belongs to
/// one thread.
class LightAtPoint final : public Integral {
 public:
  LightAtPoint(const LightingSource& source, const StartPoint<double>& start) : source_(source), start_(start) {}

  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<float>& terms) const override {
    evaluate(f32_, call, points, terms, kernels_.point_f32);
  }
  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<double>& terms) const override {
    evaluate(f64_, call, points, terms, kernels_.point_f64);
  }

 private:
  template <class T>
  void evaluate(std::optional<StartPoint<T>>& start, const TechniqueCall& call, const PointBlock& points,
                TermBlock<T>& terms, void (*kernel)(const PointCall<T>&)) const {
    if (!start) start = rounded<T>(start_);
    const Arrays<T, kTransportTechniques> arrays(source_, call, points, terms);
    kernel({&source_.transport.of<T>().scene(), &*start, source_.meanings[static_cast<std::size_t>(call.technique)],
            source_.channels, arrays.chooses(), arrays.high, arrays.low, points.stride(), arrays.values, arrays.pdfs});
  }

  LightingSource source_;
  StartPoint<double> start_;
  const EstimatorKernels& kernels_ = kernels<EstimatorKernels>();
  mutable std::optional<StartPoint<float>> f32_;
  mutable std::optional<StartPoint<double>> f64_;
};

class PlainLight final : public Integral {
 public:
  PlainLight(const LightingSource& source, const Emitters& emitters, const Receiver& receiver, const Ray& ray,
             const Tracing& tracing)
      : source_(source), emitters_(emitters), receiver_(receiver), ray_(ray), tracing_(tracing) {}

  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<float>& terms) const override {
    evaluate(f32_, call, points, terms, kernels_.lighting_f32);
  }
  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<double>& terms) const override {
    evaluate(f64_, call, points, terms, kernels_.lighting_f64);
  }

 private:
  template <class T>
  void evaluate(std::optional<LocalPixel<T>>& pixel, const TechniqueCall& call, const PointBlock& points,
                TermBlock<T>& terms, void (*kernel)(const LightingCall<T>&)) const {
    const auto has_own = [&](int t) {
      return static_cast<int>(source_.meanings[static_cast<std::size_t>(t)]) < kLightingTechniques;
    };
    if (!std::all_of(call.set.begin(), call.set.end(), has_own)) {
      if (!general_) {
        const TransportScene<double>& scene = source_.transport.of<double>().scene();
        general_ = light_at(source_, see(scene, tracing_.to_kernel(ray_.origin), ray_.direction).start);
      }
      return general_->sample(call, points, terms);
    }
    if (!pixel) pixel.emplace(source_.scene, emitters_, receiver_, -ray_.direction);
    const Arrays<T, kTransportTechniques> arrays(source_, call, points, terms);
    kernel({&pixel->data, static_cast<LightingTechnique>(call.technique), source_.channels, arrays.chooses(),
            arrays.high, arrays.low, points.stride(), arrays.values, arrays.pdfs});
  }

  LightingSource source_;
  const Emitters& emitters_;
  Receiver receiver_;
  Ray ray_;
  Tracing tracing_;
  const EstimatorKernels& kernels_ = kernels<EstimatorKernels>();
  mutable std::optional<LocalPixel<float>> f32_;
  mutable std::optional<LocalPixel<double>> f64_;
  mutable std::unique_ptr<Integral> general_;
};

}  // namespace

std::unique_ptr<Integral> light_at(const LightingSource& source, const StartPoint<double>& start) {
  return std::make_unique<LightAtPoint>(source, start);
}

std::unique_ptr<Integral> plain_light_at(const LightingSource& source, const Emitters& emitters,
                                         const Receiver& receiver, const Ray& ray, const Tracing& tracing) {
  return std::make_unique<PlainLight>(source, emitters, receiver, ray, tracing);
}

}  // namespace halfslope
