#include "estimators/heuristics.h"

#include "core/point_block.h"
#include "estimators/kernel_functions.h"

namespace halfslope::kernel {

namespace {

/// How many of something a loop runs over: known to the compiler where kFixed > 0, so that the loop is unrolled and its
/// arrays are registers.
template <int kFixed>
struct Count {
  int value;
  constexpr operator int() const { return kFixed > 0 ? kFixed : value; }
};

/// Turns the densities of every slot into ratios r_k, which all heuristics share.
template <class T, int kTechniques>
void ratios_in_place(const FoldCall<T>& call, Count<kTechniques> techniques) {
  using F = NativePacket<T>;
  constexpr int kMostTechniques = 16;
  const std::size_t rows = static_cast<std::size_t>(call.channels + call.techniques);
  for (int q = 0; q < call.slots; ++q) {
    if (call.slot_technique[q] < 0) continue;
    T* pdfs = call.terms + (static_cast<std::size_t>(q) * rows + static_cast<std::size_t>(call.channels)) * call.stride;
    for (std::size_t p = 0; p < call.count; p += kWidth<F>) {
      F ratios[kTechniques > 0 ? kTechniques : kMostTechniques];
      const auto scaled = [&](int k) {
        return F(call.counts[k]) * load<F>(pdfs + static_cast<std::size_t>(k) * call.stride + p);
      };
      ratios[0] = scaled(0);
      for (int k = 1; k < techniques; ++k) ratios[k] = scaled(k);
      to_ratios(ratios, techniques);
      for (int k = 0; k < techniques; ++k) store(pdfs + static_cast<std::size_t>(k) * call.stride + p, ratios[k]);
    }
  }
}

/// One heuristic's estimate from each point's round.
template <class T, int kTechniques, int kSlots, int kChannels>
void weigh(const FoldCall<T>& call, Heuristic heuristic, Count<kTechniques> techniques, Count<kSlots> slots,
           Count<kChannels> channels, T* const* out) {
  using F = NativePacket<T>;
  constexpr int kMostTechniques = 16, kMostChannels = 3;
  const std::size_t rows = static_cast<std::size_t>(call.channels + call.techniques);
  for (std::size_t p = 0; p < call.count; p += kWidth<F>) {
    F sums[kMostChannels];
    for (int c = 0; c < channels; ++c) sums[c] = F(T(0));
    for (int q = 0; q < slots; ++q) {
      const T* values = call.terms + static_cast<std::size_t>(q) * rows * call.stride + p;
      const T* pdfs = values + static_cast<std::size_t>(call.channels) * call.stride;
      // One slot a technique: slot q is technique q, and indices are known to the compiler.
      const int i = kSlots > 0 && kSlots == kTechniques ? q : call.slot_technique[q];
      if (kSlots == 0 && i < 0) {
        for (int c = 0; c < channels; ++c) {
          sums[c] = sums[c] + load<F>(values + static_cast<std::size_t>(c) * call.stride);
        }
        continue;
      }
      F ratios[kTechniques > 0 ? kTechniques : kMostTechniques];
      ratios[0] = load<F>(pdfs);
      for (int k = 1; k < techniques; ++k) ratios[k] = load<F>(pdfs + static_cast<std::size_t>(k) * call.stride);
      const F w = F(T(1) / call.counts[i]) * weight(heuristic, ratios, techniques, i);
      for (int c = 0; c < channels; ++c) {
        sums[c] = fma(w, load<F>(values + static_cast<std::size_t>(c) * call.stride), sums[c]);
      }
    }
    for (int c = 0; c < channels; ++c) store(out[c] + p, sums[c]);
  }
}

/// A pair of techniques, one sample each, on a grey scene is what most experiments do: it gets loops of its own.
template <class T>
void weigh_all(const FoldCall<T>& call) {
  for (int h = 0; h < call.heuristic_count; ++h) {
    T* const* out = call.out + h * call.channels;
    if (call.techniques == 2 && call.slots == 2 && call.channels == 1) {
      weigh(call, call.heuristics[h], Count<2>{2}, Count<2>{2}, Count<1>{1}, out);
    } else if (call.techniques == 2 && call.channels == 3) {
      weigh(call, call.heuristics[h], Count<2>{2}, Count<0>{call.slots}, Count<3>{3}, out);
    } else {
      weigh(call, call.heuristics[h], Count<0>{call.techniques}, Count<0>{call.slots}, Count<0>{call.channels}, out);
    }
  }
}

}  // namespace

template <class T>
void fold(const FoldCall<T>& call) {
  if (call.techniques == 2) {
    ratios_in_place(call, Count<2>{2});
  } else if (call.techniques > 2) {
    ratios_in_place(call, Count<0>{call.techniques});
  }
  weigh_all(call);
  if (call.regression) regress(call);
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
