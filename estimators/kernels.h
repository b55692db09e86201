// The vectorised estimators: plain data across the border to an instruction set's library.
#pragma once

#include <cstddef>
#include <cstdint>

#include "estimators/pixel_data.h"
#include "estimators/transport_calls.h"

namespace halfslope {

/// One sample of a technique at each of `count` points (a multiple of kLanes). `high[d]`, `low[d]`: the technique's own
/// dimensions. values[c] receives f/p of channel c; pdfs[t] the density of technique t in solid angle, unless null.
template <class T>
struct LightingCall {
  const PixelData<T>* pixel;
  LightingTechnique technique;
  int channels;  ///< 1 or 3
  bool choose;   ///< whether the first dimension chooses: what an area technique draws its point on, or a lobe
  const std::uint32_t* const* high;
  const std::uint32_t* const* low;
  std::size_t count;
  T* const* values;
  T* const* pdfs;  ///< kLightingTechniques of them
};

/// How the terms of a round are weighted: a fold of them by estimators/heuristics.h, or by estimators/optimal.h, whose
/// weights are not known before many rounds are.
enum class HeuristicKind : std::uint8_t {
  kSingle,
  kOnly,
  kAverage,
  kBalance,
  kPower,
  kCutoff,
  kMaximum,
  kCustom,
  kOptimal,
  kOptimalProgressive
};
/// Whether the heuristic is a fold of a round's terms, with weights that are nowhere negative.
constexpr bool is_fold(HeuristicKind kind) {
  return kind != HeuristicKind::kOptimal && kind != HeuristicKind::kOptimalProgressive;
}

/// The weight in [0, 1] of technique i, from the ratios r_k = c_k p_k / max_l c_l p_l of all `techniques` (where every
/// density is 0, all ratios are equal). Equal densities may differ by rounding, and not the same way at each
/// technique's samples: a weight that jumps must not jump there.
using WeightFunction = double (*)(const double* ratios, int techniques, int i);

struct Heuristic {
  HeuristicKind kind = HeuristicKind::kSingle;
  double parameter = 0;             ///< β of power, α of cutoff, the technique in the set of only
  WeightFunction custom = nullptr;  ///< of kCustom
};

/// Terms of `count` points: slot q's arrays begin at terms + q · (channels + techniques) · stride, channels first, then
/// the densities. out[h · channels + c] receives heuristic h's estimate from each point's round.
template <class T>
struct FoldCall {
  T* terms;  ///< densities are overwritten: with c_k p_k over the largest of them
  std::size_t stride, count;
  int slots, channels, techniques;
  const int* slot_technique;    ///< which technique of the set each slot draws; −1: a term of weight 1
  const T* counts;              ///< samples of each technique in a round
  const Heuristic* heuristics;  ///< folds all
  int heuristic_count;
  T* const* out;
  /// Where not null, it receives what estimators/optimal.h adds up, each point's sums over its round: w_i w_j for
  /// i ≥ j, row by row, then y w_i for each channel of y, the balance heuristic's weights w and contribution y.
  T* const* regression = nullptr;
};

/// Adds `samples` rows of kLanes values of each output to its lanes' compensated sums (kLanes numbers an output).
template <class T>
using AccumulateValues = void (*)(const T* const* values, int outputs, int samples, double* sums,
                                  double* compensations);

struct EstimatorKernels {
  static constexpr const char* kSymbol = "halfslope_estimator_kernels";
  void (*lighting_f32)(const LightingCall<float>&);
  void (*lighting_f64)(const LightingCall<double>&);
  void (*fold_f32)(const FoldCall<float>&);
  void (*fold_f64)(const FoldCall<double>&);
  AccumulateValues<float> accumulate_f32;
  AccumulateValues<double> accumulate_f64;
  void (*point_f32)(const PointCall<float>&);
  void (*point_f64)(const PointCall<double>&);
  void (*paths_f32)(const PathCall<float>&);
  void (*paths_f64)(const PathCall<double>&);
};

}  // namespace halfslope
