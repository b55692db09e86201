#include "experiments/reference.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "analysis/compensated_sum.h"
#include "core/error.h"
#include "experiments/reference_renderer.h"

namespace halfslope {
namespace {

constexpr std::int64_t kFirstReplicates = 16;
constexpr std::int64_t kFewReplicates = 256;  // beyond which a larger N is tried first, where that is allowed
constexpr std::uint64_t kMoreSamples = 8;

double mean_variance(const std::vector<Moments>& moments) {
  CompensatedSum sum;
  for (const Moments& m : moments) sum.add(m.variance());
  return sum.value() / static_cast<double>(moments.size());
}

// √ of the mean over integrals of (standard error / value)²; integrals without spread are exact.
double relative_error(const std::vector<Moments>& moments) {
  CompensatedSum sum;
  std::size_t uncertain = 0;
  for (const Moments& m : moments) {
    if (!(m.central2 > 0)) continue;
    const double ratio = m.standard_error() / m.mean;
    sum.add(ratio * ratio);
    ++uncertain;
  }
  return uncertain > 0 ? std::sqrt(sum.value() / static_cast<double>(uncertain)) : 0;
}

Reference closed_form_reference(const IntegralSource& source, const std::vector<int>& pixels) {
  Reference reference;
  reference.origin = "closed form";
  CompensatedSum sum;
  for (const int pixel : pixels) {
    const Color exact = *source.closed_form(pixel);
    for (int c = 0; c < source.channels(); ++c) {
      reference.value.push_back(exact[static_cast<std::size_t>(c)]);
      sum.add(exact[static_cast<std::size_t>(c)]);
    }
  }
  reference.variance.assign(reference.value.size(), 0.0);
  reference.mean = sum.value() / static_cast<double>(reference.value.size());
  return reference;
}

/// How near a reference came to its goal.
struct Outcome {
  bool reached;
  double share, relative;
};

Outcome render_until(ReferenceRenderer& renderer, ReferenceState& state, const ReferenceGoal& goal, bool may_grow) {
  const std::int64_t most = may_grow ? std::min(kFewReplicates, goal.most_replicates) : goal.most_replicates;
  for (std::int64_t replicates = kFirstReplicates;; replicates *= 2) {
    renderer.extend(state, replicates);
    const double own = mean_variance(state.full) / static_cast<double>(replicates);
    if (!std::isfinite(own)) return {true, 0, 0};  // more would not mend it; the cells will be invalid
    const double expected = mean_variance(state.compared), share = expected > 0 ? own / expected : 0;
    const double relative = relative_error(state.full);
    const bool reached = (goal.error_share == 0 || share <= goal.error_share) &&
                         (goal.relative_error == 0 || relative <= goal.relative_error);
    if (reached || 2 * replicates > most) return {reached, share, relative};
    // Variances fall like one over the replicates, so this many would be needed.
    const double share_left = goal.error_share > 0 ? share / goal.error_share : 0;
    const double relative_left = goal.relative_error > 0 ? std::pow(relative / goal.relative_error, 2) : 0;
    if (may_grow && static_cast<double>(replicates) * std::max(share_left, relative_left) > kFewReplicates)
      return {false, share, relative};
  }
}

Reference finished(const ReferenceRenderer& renderer, const ReferenceState& state) {
  Reference reference;
  reference.samples = renderer.samples();
  reference.replicates = state.replicates();
  const auto replicates = static_cast<double>(reference.replicates);
  reference.origin = fmt::format("balance heuristic, halton-owen, f64, {} replicates of N = {}", reference.replicates,
                                 reference.samples);
  for (const Moments& m : state.full) {
    reference.value.push_back(m.mean);
    reference.variance.push_back(m.variance() / replicates);
  }
  reference.mean_variance = mean_variance(state.full) / replicates;
  Moments means;
  std::vector<double> image_means;
  for (const double sum : state.replicate_sums) image_means.push_back(sum / static_cast<double>(state.full.size()));
  means.add(std::span<const double>(image_means));
  reference.mean = means.mean;
  reference.mean_se = means.standard_error();
  return reference;
}

[[noreturn]] void refuse(const std::string& name, const ReferenceRenderer& renderer, const ReferenceState& state,
                         const ReferenceGoal& goal, const Outcome& outcome) {
  const std::string spent = fmt::format("scene '{}': after {} replicates of N = {} the reference's", name,
                                        state.replicates(), renderer.samples());
  if (goal.error_share > 0 && outcome.share > goal.error_share) {
    fail(ExitCode::kBadInput, "{} variance is still {:.3g} times what errors at N = {} allow; measure at smaller N",
         spent, outcome.share / goal.error_share, goal.compare_samples);
  }
  fail(ExitCode::kBadInput,
       "{} relative error is still {:.3g}, and {:.3g} was asked for; give it more --samples or --max-replicates, or "
       "ask for a larger --relative-error",
       spent, outcome.relative, goal.relative_error);
}

}  // namespace

std::optional<std::size_t> Reference::first_nonfinite(int channels) const {
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!std::isfinite(value[i]) || !std::isfinite(variance[i])) return i / static_cast<std::size_t>(channels);
  }
  return std::nullopt;
}

bool has_closed_form(const IntegralSource& source, const std::vector<int>& pixels) {
  return std::all_of(pixels.begin(), pixels.end(), [&](int pixel) { return source.closed_form(pixel).has_value(); });
}

Reference make_reference(const IntegralSource& source, const std::string& name, const std::vector<int>& pixels,
                         const ReferenceGoal& goal, const ReferenceOptions& options, const SamplerCatalogue& samplers) {
  if (has_closed_form(source, pixels)) return closed_form_reference(source, pixels);
  for (ReferenceGoal at = goal;; at.samples *= kMoreSamples) {
    ReferenceRenderer renderer(source, name, pixels, at, options, samplers);
    // Scrambled points gain more from N than from replicates, so N grows as long as it may.
    const bool may_grow = at.samples * kMoreSamples <= goal.most_samples;
    ReferenceState state;
    const Outcome outcome = render_until(renderer, state, at, may_grow);
    if (outcome.reached) return finished(renderer, state);
    if (!may_grow) refuse(name, renderer, state, at, outcome);
  }
}

std::int64_t cached_replicates(const IntegralSource& source, const std::vector<int>& pixels, const ReferenceGoal& goal,
                               const std::filesystem::path& cache, const SamplerCatalogue& samplers) {
  if (has_closed_form(source, pixels)) return 0;
  const ReferenceOptions options = {0, true, cache};
  const std::string name;
  const ReferenceRenderer renderer(source, name, pixels, goal, options, samplers);
  std::int64_t held = 0;
  for (std::int64_t r = kFirstReplicates; renderer.cached(r); r *= 2) held = r;
  return held;
}

std::filesystem::path default_cache() {
  if (const char* folder = std::getenv("HALFSLOPE_CACHE")) return folder;
  if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder && *folder)
    return std::filesystem::path(folder) / "halfslope";
  if (const char* home = std::getenv("HOME"); home && *home)
    return std::filesystem::path(home) / ".cache" / "halfslope";
  return {};
}

}  // namespace halfslope
