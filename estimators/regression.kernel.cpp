// The sums that the optimal weights are solved from; see estimators/optimal.h.
#include "estimators/heuristics.h"
#include "estimators/kernel_functions.h"

namespace halfslope::kernel {
namespace {

/// The balance heuristic's weights; where every density is said to be 0, all to technique `own`, which drew the sample.
template <class F>
void balance_weights(const F* ratios, int techniques, int own, F* weights) {
  const F zero(scalar_t<F>(0)), one(scalar_t<F>(1));
  F sum = ratios[0];
  for (int k = 1; k < techniques; ++k) sum = sum + ratios[k];
  const auto any = any_density(ratios, techniques);
  const F nan = nan_of(ratios, techniques);
  for (int k = 0; k < techniques; ++k) weights[k] = select(any, ratios[k] / sum, k == own ? one : zero) + nan;
}

}  // namespace

template <class T>
void regress(const FoldCall<T>& call) {
  using F = NativePacket<T>;
  constexpr int kMostTechniques = 16;
  const std::size_t rows = static_cast<std::size_t>(call.channels + call.techniques);
  for (std::size_t p = 0; p < call.count; p += kWidth<F>) {
    for (int q = 0; q < call.slots; ++q) {
      const T* values = call.terms + static_cast<std::size_t>(q) * rows * call.stride + p;
      const T* pdfs = values + static_cast<std::size_t>(call.channels) * call.stride;
      F ratios[kMostTechniques], w[kMostTechniques];
      for (int k = 0; k < call.techniques; ++k) ratios[k] = load<F>(pdfs + static_cast<std::size_t>(k) * call.stride);
      const int own = call.slot_technique[q];
      balance_weights(ratios, call.techniques, own, w);
      T* const* out = call.regression;
      const auto add = [&](const F& a, const F& b) {
        T* to = *out++ + p;
        store(to, q == 0 ? a * b : fma(a, b, load<F>(to)));
      };
      for (int i = 0; i < call.techniques; ++i) {
        for (int j = 0; j <= i; ++j) add(w[i], w[j]);
      }
      for (int c = 0; c < call.channels; ++c) {
        const F y = load<F>(values + static_cast<std::size_t>(c) * call.stride) * (w[own] * F(T(1) / call.counts[own]));
        for (int i = 0; i < call.techniques; ++i) add(y, w[i]);
      }
    }
  }
}
template void regress<float>(const FoldCall<float>&);
template void regress<double>(const FoldCall<double>&);

}  // namespace halfslope::kernel
