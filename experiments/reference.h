// What errors are measured against.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/moments.h"
#include "experiments/plan.h"

namespace halfslope {

/// The reference of one scene: for each chosen pixel and channel (pixel-major) its value and the variance of that
/// value; 0 where the value is exact.
struct Reference {
  std::vector<double> value, variance;
  double mean = 0;           ///< over pixels and channels
  double mean_se = 0;        ///< its standard error
  double mean_variance = 0;  ///< V̄
  std::string origin;        ///< "closed form", or how it was rendered
  std::uint64_t samples = 0;
  std::int64_t replicates = 0;

  /// The position of the first pixel whose value or variance is not finite.
  std::optional<std::size_t> first_nonfinite(int channels) const;
};

/// When a rendered reference is good enough.
struct ReferenceGoal {
  std::uint64_t samples = 4096;          ///< N of each replicate
  std::uint64_t compare_samples = 1024;  ///< the largest N it judges
  /// V̄ at most this share of the smallest mean squared error expected at compare_samples; 0 for no such goal.
  double error_share = 0;
  /// Root mean square of the pixels' relative standard errors at most this; 0 for no such goal.
  double relative_error = 0;
  std::int64_t most_replicates = 1 << 14;
  /// Where 256 replicates would not reach the goal, N grows eightfold and they start anew, up to this N; only then
  /// are there more replicates. 0: N stays what it is.
  std::uint64_t most_samples = 0;
};

struct ReferenceOptions {
  int threads = 0;  ///< 0: all
  bool quiet = false;
  std::filesystem::path cache;  ///< folder of finished references; empty: none
};

/// Whether every chosen pixel is known in closed form.
bool has_closed_form(const IntegralSource& source, const std::vector<int>& pixels);

/// The reference of the chosen pixels: the closed form where there is one, else the balance heuristic over the
/// source's reference techniques in binary64 on halton-owen points with keys of their own, replicates doubled from 16
/// until the goal is met. The same for any threads and any state of the cache. Throws Error(kBadInput) if
/// most_replicates do not reach the goal, saying what to do, and Error(kInterrupted).
Reference make_reference(const IntegralSource& source, const std::string& name, const std::vector<int>& pixels,
                         const ReferenceGoal& goal, const ReferenceOptions& options, const SamplerCatalogue& samplers);

/// How many replicates of that reference the cache holds from the first on; 0 for a closed form.
std::int64_t cached_replicates(const IntegralSource& source, const std::vector<int>& pixels, const ReferenceGoal& goal,
                               const std::filesystem::path& cache, const SamplerCatalogue& samplers);

/// $HALFSLOPE_CACHE, or halfslope/ in $XDG_CACHE_HOME or ~/.cache; empty where neither is known.
std::filesystem::path default_cache();

}  // namespace halfslope
