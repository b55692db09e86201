// The vectorised loops of analysis: plain data across the border to an instruction set's library.
#pragma once

#include <cstddef>

namespace halfslope {

/// The kernels k(z, z') of one dimension, z = x − ½, that products over dimensions know shorter ways to than the
/// general one, g(z) + g(z') + h z z' − c |z − z'|.
enum class QuadraticForm : int {
  kGeneral,
  kMinimum,    ///< 2 min(½ − z, ½ − z')
  kInterval,   ///< 4 (½ − max(z, z')) (½ + min(z, z'))
  kSymmetric,  ///< 1 − |z − z'|
  kCentered,   ///< 1 + min(|z|, |z'|) where both are on one side, else 1
  kPeriodic,   ///< offset + scale (½ − |z − z'|)²
  kMixture,    ///< 15/8 − (|z| + |z'|)/4 − ¾ |z − z'| + ½ (z − z')²
};

/// Two binary64 that stand for their sum.
struct PairSum {
  double high, low;
};

/// Points in the form that the products over dimensions want: [dim][stride], 64-byte aligned, padded with zeros to a
/// multiple of kPairLanes.
struct PairProducts {
  static constexpr std::size_t kPairLanes = 16;
  QuadraticForm form;
  std::size_t dims, count, stride;
  const double *z_high, *z_low;  ///< x − ½ as a multiple of 2⁻⁵³ and a rest; the rest null unless general
  const double *g_high, *g_low;  ///< g(z); null unless general
  double h, c;                   ///< unless general, any
  PairSum offset;                ///< kPeriodic's
  double scale;                  ///< kPeriodic's, a power of two
};

struct AnalysisKernels {
  static constexpr const char* kSymbol = "halfslope_analysis_kernels";

  /// Σ_i Σ_j Π_k k(z_ik, z_jk) over i in [i_begin, i_end) and j in [j_begin, j_end), to about 100 bits; j_begin is a
  /// multiple of kPairLanes. The order of the sum depends on neither packets nor threads.
  PairSum (*pair_products)(const PairProducts& points, std::size_t i_begin, std::size_t i_end, std::size_t j_begin,
                           std::size_t j_end);
};

}  // namespace halfslope
