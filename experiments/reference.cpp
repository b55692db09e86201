#include "experiments/reference.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "analysis/compensated_sum.h"
#include "analysis/reference_noise.h"
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

std::vector<double> variances(const ReferenceState& state) {
  std::vector<double> each;
  for (const Moments& m : state.moments) each.push_back(m.variance());
  return each;
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
  reference.half_a = reference.half_b = reference.value;
  reference.mean = sum.value() / static_cast<double>(reference.value.size());
  return reference;
}

/// How near a reference came to its goal: its variance as a multiple of what the goal allows (0 where it asks for
/// none), its relative error, and about how many replicates would reach it.
struct Outcome {
  bool reached;
  double excess, relative, needed;
};

// Variances fall like one over the replicates, so how many are needed is known to a factor after the first.
constexpr double kPlainlyTooMany = 4;

Outcome render_until(ReferenceRenderer& renderer, ReferenceState& state, const ReferenceGoal& goal, bool may_grow,
                     std::optional<AllowedVariance>& allowed) {
  const std::int64_t most = may_grow ? std::min(kFewReplicates, goal.most_replicates) : goal.most_replicates;
  for (std::int64_t replicates = kFirstReplicates;; replicates *= 2) {
    renderer.extend(state, replicates);
    const auto n = static_cast<double>(replicates);
    const double variance = mean_variance(state.moments);
    if (!std::isfinite(variance)) return {true, 0, 0, 0};  // more would not mend it; the cells will be invalid
    if (!allowed) allowed = goal.allowed ? goal.allowed(variances(state)) : AllowedVariance{};
    Outcome at = {true, 0, relative_error(state.moments), 0};
    if (allowed->most > 0) {
      at.excess = variance / n / allowed->most;
      at.reached = at.excess <= 1;
      at.needed = n * at.excess;
    }
    if (goal.relative_error > 0) {
      at.reached = at.reached && at.relative <= goal.relative_error;
      at.needed = std::max(at.needed, n * std::pow(at.relative / goal.relative_error, 2));
    }
    if (at.reached || 2 * replicates > most) return at;
    if (may_grow ? at.needed > kFewReplicates : at.needed > kPlainlyTooMany * static_cast<double>(most)) return at;
  }
}

Reference finished(const ReferenceRenderer& renderer, const ReferenceState& state) {
  Reference reference;
  reference.samples = renderer.samples();
  reference.replicates = state.replicates();
  const auto replicates = static_cast<double>(reference.replicates);
  reference.origin = fmt::format("balance heuristic, halton-owen, f64, {} replicates of N = {}", reference.replicates,
                                 reference.samples);
  std::vector<double> weights;
  for (std::size_t i = 0; i < state.moments.size(); ++i) {
    const Moments& m = state.moments[i];
    reference.value.push_back(m.mean);
    reference.variance.push_back(m.variance() / replicates);
    reference.half_a.push_back(state.half[i]);
    reference.half_b.push_back(2 * m.mean - state.half[i]);
    weights.push_back(1 / (m.mean * m.mean + 0.01));
  }
  reference.mean_variance = mean_variance(state.moments) / replicates;
  reference.mse_noise = mean_square_noise(reference.variance, renderer.channels());
  CompensatedSum relative;
  for (std::size_t i = 0; i < weights.size(); ++i) relative.add(weights[i] * reference.variance[i]);
  reference.mean_relative_variance = relative.value() / static_cast<double>(weights.size());
  reference.relmse_noise = mean_square_noise(reference.variance, renderer.channels(), weights);
  Moments means;
  std::vector<double> image_means;
  for (const double sum : state.replicate_sums) image_means.push_back(sum / static_cast<double>(state.moments.size()));
  means.add(std::span<const double>(image_means));
  reference.mean = means.mean;
  reference.mean_se = means.standard_error();
  return reference;
}

[[noreturn]] void refuse(const std::string& name, const ReferenceRenderer& renderer, const ReferenceState& state,
                         const ReferenceGoal& goal, const AllowedVariance& allowed, const Outcome& outcome) {
  const std::string spent = fmt::format("scene '{}': after {} replicates of N = {} the reference's", name,
                                        state.replicates(), renderer.samples());
  const std::string needed =
      fmt::format("about {:.2g} replicates would do, {} are the most", outcome.needed, goal.most_replicates);
  if (outcome.excess > 1) {
    fail(ExitCode::kBadInput,
         "{} variance is still {:.3g} times what the smallest error to be measured allows, that of {}: {}; measure "
         "smaller N, or leave that one out",
         spent, outcome.excess, allowed.asked_by, needed);
  }
  fail(
      ExitCode::kBadInput,
      "{} relative error is still {:.3g}, and {:.3g} was asked for: {}; give it more --samples or --max-replicates, or "
      "ask for a larger --relative-error",
      spent, outcome.relative, goal.relative_error, needed);
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
  std::optional<AllowedVariance> allowed;
  for (ReferenceGoal at = goal;; at.samples *= kMoreSamples) {
    ReferenceRenderer renderer(source, name, pixels, at, options, samplers);
    // Scrambled points gain more from N than from replicates, so N grows as long as it may.
    const bool may_grow = at.samples * kMoreSamples <= goal.most_samples;
    ReferenceState state;
    const Outcome outcome = render_until(renderer, state, at, may_grow, allowed);
    if (outcome.reached) return finished(renderer, state);
    if (!may_grow) refuse(name, renderer, state, at, *allowed, outcome);
  }
}

CachedReplicates cached_replicates(const IntegralSource& source, const std::vector<int>& pixels,
                                   const ReferenceGoal& goal, const std::filesystem::path& cache,
                                   const SamplerCatalogue& samplers) {
  CachedReplicates held;
  if (has_closed_form(source, pixels)) return held;
  const ReferenceOptions options = {0, true, cache};
  const std::string name;
  for (ReferenceGoal at = goal;; at.samples *= kMoreSamples) {
    const ReferenceRenderer renderer(source, name, pixels, at, options, samplers);
    for (std::int64_t r = kFirstReplicates; renderer.cached(r); r *= 2) held = {renderer.samples(), r};
    if (at.samples * kMoreSamples > goal.most_samples) return held;
  }
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
