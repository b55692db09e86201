#include "estimators/heuristics.h"

#include "core/point_block.h"
#include "estimators/kernel_functions.h"

namespace halfslope::kernel {

template <class T>
void fold(const FoldCall<T>& call) {
  using F = NativePacket<T>;
  constexpr int kMostTechniques = 16, kMostOutputs = 3 * kMostHeuristics;
  const std::size_t slot_size = static_cast<std::size_t>(call.channels + call.techniques) * call.stride;
  const bool single = call.techniques == 1;
  for (std::size_t p = 0; p < call.count; p += kWidth<F>) {
    F out[kMostOutputs];
    for (int o = 0; o < call.heuristic_count * call.channels; ++o) out[o] = F(T(0));
    for (int q = 0; q < call.slots; ++q) {
      const T* slot = call.terms + static_cast<std::size_t>(q) * slot_size + p;
      const int i = call.slot_technique[q];
      F ratios[kMostTechniques];
      if (!single) {
        for (int k = 0; k < call.techniques; ++k) {
          ratios[k] = F(call.counts[k]) * load<F>(slot + static_cast<std::size_t>(call.channels + k) * call.stride);
        }
        to_ratios(ratios, call.techniques);
      }
      const F share(T(1) / call.counts[i]);
      for (int h = 0; h < call.heuristic_count; ++h) {
        const F w = share * weight(call.heuristics[h], ratios, call.techniques, i);
        for (int c = 0; c < call.channels; ++c) {
          F& sum = out[h * call.channels + c];
          sum = fma(w, load<F>(slot + static_cast<std::size_t>(c) * call.stride), sum);
        }
      }
    }
    for (int o = 0; o < call.heuristic_count * call.channels; ++o) store(call.out[o] + p, out[o]);
  }
}
template void fold<float>(const FoldCall<float>&);
template void fold<double>(const FoldCall<double>&);

// Kahan's sum in each lane, rows in order: a replicate's sum is its own, whatever the packet width. Each is a chain of
// four dependent additions, so kTogether outputs run side by side, in registers, and fill each other's waiting.
template <class T, int kTogether>
void accumulate_some(const T* const* values, int samples, double* sums, double* compensations) {
  double sum[kTogether][kLanes], compensation[kTogether][kLanes];
  for (int o = 0; o < kTogether; ++o) {
    for (int l = 0; l < kLanes; ++l) {
      sum[o][l] = sums[o * kLanes + l];
      compensation[o][l] = compensations[o * kLanes + l];
    }
  }
  for (int s = 0; s < samples; ++s) {
    for (int o = 0; o < kTogether; ++o) {
      const T* row = values[o] + static_cast<std::size_t>(s) * kLanes;
      for (int l = 0; l < kLanes; ++l) {
        const double y = static_cast<double>(row[l]) - compensation[o][l];
        const double t = sum[o][l] + y;
        compensation[o][l] = (t - sum[o][l]) - y;
        sum[o][l] = t;
      }
    }
  }
  for (int o = 0; o < kTogether; ++o) {
    for (int l = 0; l < kLanes; ++l) {
      sums[o * kLanes + l] = sum[o][l];
      compensations[o * kLanes + l] = compensation[o][l];
    }
  }
}

template <class T>
void accumulate(const T* const* values, int outputs, int samples, double* sums, double* compensations) {
  int o = 0;
  for (; o + 3 <= outputs; o += 3)
    accumulate_some<T, 3>(values + o, samples, sums + o * kLanes, compensations + o * kLanes);
  for (; o < outputs; ++o) accumulate_some<T, 1>(values + o, samples, sums + o * kLanes, compensations + o * kLanes);
}
template void accumulate<float>(const float* const*, int, int, double*, double*);
template void accumulate<double>(const double* const*, int, int, double*, double*);

}  // namespace halfslope::kernel
