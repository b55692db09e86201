// What errors are measured against.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/moments.h"
#include "experiments/plan.h"

namespace halfslope {

/// The reference of one scene: for each chosen pixel and channel (pixel-major) its value and the variance of that
/// value; 0 where the value is exact.
struct Reference {
  std::vector<double> value, variance;
  /// The means of the first and of the second half of the replicates, independent of one another: their mean is the
  /// value (analysis/half_buffers.h). Both the value itself where that is exact.
  std::vector<double> half_a, half_b;
  double mean = 0;                    ///< over pixels and channels
  double mean_se = 0;                 ///< its standard error
  double mean_variance = 0;           ///< V̄
  double mse_noise = 0;               ///< of the mean of squared errors against it (analysis/reference_noise.h)
  double mean_relative_variance = 0;  ///< mean of Var(R̂)/(R̂² + 0.01), what relmse has of it
  double relmse_noise = 0;            ///< as mse_noise, of relmse
  std::string origin;                 ///< "closed form", or how it was rendered
  std::uint64_t samples = 0;
  std::int64_t replicates = 0;

  /// The position of the first pixel whose value or variance is not finite.
  std::optional<std::size_t> first_nonfinite(int channels) const;
};

/// The most that a reference's mean variance V̄ may be, and for whose sake: a cell, in the refusal's message.
struct AllowedVariance {
  double most = 0;  ///< 0: anything
  std::string asked_by;
};

/// When a rendered reference is good enough.
struct ReferenceGoal {
  std::uint64_t samples = 4096;  ///< N of each replicate
  /// Asked once, when the first 16 replicates stand, with the variance over them of every integral. Empty: no such
  /// goal.
  std::function<AllowedVariance(std::span<const double> variances)> allowed = nullptr;
  /// Root mean square of the pixels' relative standard errors at most this; 0 for no such goal.
  double relative_error = 0;
  std::int64_t most_replicates = 1 << 14;
  /// Where 256 replicates would not reach the goal, N grows eightfold and they start anew, up to this N; only then
  /// are there more replicates. 0: N stays what it is.
  std::uint64_t most_samples = 0;
};

/// The numbers of a reference's first replicate. A run's replicates are below 2^31 (`replicates` of an experiment) and
/// random numbers are a bijection of (replicate, pixel, dimension, …) under each key, so what a reference draws is
/// never what a run draws, whatever its seed: keys alone cannot promise that, since every key is some seed's.
inline constexpr std::uint32_t kFirstReferenceReplicate = std::uint32_t{1} << 31;

struct ReferenceOptions {
  int threads = 0;  ///< 0: all
  bool quiet = false;
  std::filesystem::path cache;  ///< folder of finished references; empty: none
};

/// Whether every chosen pixel is known in closed form.
bool has_closed_form(const IntegralSource& source, const std::vector<int>& pixels);

/// The reference of the chosen pixels: the closed form where there is one, else the balance heuristic over the
/// source's reference techniques in binary64 on halton-owen points with random numbers of their own, replicates doubled
/// from 16 until the goal is met. The same for any threads and any state of the cache. Throws Error(kBadInput) if
/// most_replicates do not reach the goal (as soon as that is plain), saying what to do, and Error(kInterrupted).
Reference make_reference(const IntegralSource& source, const std::string& name, const std::vector<int>& pixels,
                         const ReferenceGoal& goal, const ReferenceOptions& options, const SamplerCatalogue& samplers);

/// How many replicates of that reference the cache holds from the first on, at the largest N that it has any of; 0 for
/// a closed form.
struct CachedReplicates {
  std::uint64_t samples = 0;
  std::int64_t replicates = 0;
};
CachedReplicates cached_replicates(const IntegralSource& source, const std::vector<int>& pixels,
                                   const ReferenceGoal& goal, const std::filesystem::path& cache,
                                   const SamplerCatalogue& samplers);

/// $HALFSLOPE_CACHE, or halfslope/ in $XDG_CACHE_HOME or ~/.cache; empty where neither is known.
std::filesystem::path default_cache();

}  // namespace halfslope
