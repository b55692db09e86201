// The vectorised estimators: plain data across the border to an instruction set's library.
#pragma once

#include <cstddef>
#include <cstdint>

#include "estimators/pixel_data.h"

namespace halfslope {

/// One sample of a technique at each of `count` points (a multiple of kLanes). `high[d]`, `low[d]`: the technique's own
/// dimensions. values[c] receives f/p of channel c; pdf_light and pdf_bsdf the densities in solid angle, unless null.
template <class T>
struct LightingCall {
  const PixelData<T>* pixel;
  int channels;  ///< 1 or 3
  const std::uint32_t* const* high;
  const std::uint32_t* const* low;
  std::size_t count;
  T* const* values;
  T* pdf_light;
  T* pdf_bsdf;
};

/// How the terms of a round are weighted; see estimators/heuristics.h.
enum class HeuristicKind : std::uint8_t { kSingle, kAverage, kBalance, kPower };
struct Heuristic {
  HeuristicKind kind = HeuristicKind::kSingle;
  double parameter = 0;  ///< β of the power heuristic
};

/// Terms of `count` points: slot q's arrays begin at terms + q · (channels + techniques) · stride, channels first, then
/// the densities. out[h · channels + c] receives heuristic h's estimate from each point's round.
template <class T>
struct FoldCall {
  T* terms;  ///< densities are overwritten: with c_k p_k over the largest of them
  std::size_t stride, count;
  int slots, channels, techniques;
  const int* slot_technique;  ///< which technique of the set each slot draws
  const T* counts;            ///< samples of each technique in a round
  const Heuristic* heuristics;
  int heuristic_count;
  T* const* out;
};

/// Adds `samples` rows of kLanes values of each output to its lanes' compensated sums (kLanes numbers an output).
template <class T>
using AccumulateValues = void (*)(const T* const* values, int outputs, int samples, double* sums,
                                  double* compensations);

struct EstimatorKernels {
  static constexpr const char* kSymbol = "halfslope_estimator_kernels";
  void (*light_f32)(const LightingCall<float>&);
  void (*light_f64)(const LightingCall<double>&);
  void (*bsdf_f32)(const LightingCall<float>&);
  void (*bsdf_f64)(const LightingCall<double>&);
  void (*fold_f32)(const FoldCall<float>&);
  void (*fold_f64)(const FoldCall<double>&);
  AccumulateValues<float> accumulate_f32;
  AccumulateValues<double> accumulate_f64;
};

}  // namespace halfslope
