// A small measurement before the measurement: how small the errors of an experiment will be.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "experiments/plan.h"

namespace halfslope {

/// Replicates of a pilot.
inline constexpr std::int64_t kPilotReplicates = 16;
/// Their first number: beyond those of runs and of references (experiments/reference.h), so nothing is drawn twice.
inline constexpr std::uint32_t kFirstPilotReplicate = std::uint32_t{3} << 30;

/// What is measured of one pass of a plan: its largest N, and of a sequence the smaller ones that come with it.
struct PilotPass {
  Precision precision = Precision::kF32;
  std::string sampler;
  Allocation allocation;
  std::vector<std::size_t> estimators;  ///< indices into the scene's
  std::vector<std::uint64_t> samples;
  std::int64_t replicates = kPilotReplicates;
  std::string in_place_of;  ///< the deterministic sampler that it stands for; empty: none
};

/// A pilot of one scene: the passes of its plan over some of its pixels. It depends on neither the seed nor the
/// replicates of the plan.
///
/// A deterministic sampler's error cannot be told from the spread of replicates: halton-owen stands in for it, at the
/// same N. What cannot be told at all is left out, with the reason.
struct Pilot {
  std::size_t pixels = 0;  ///< how many at most: 64, or those that are sampled at all
  std::vector<PilotPass> passes;
  std::vector<std::string> left_out;
  double evaluations() const;  ///< integrand evaluations it takes at most
};
Pilot plan_pilot(const Plan& plan, std::size_t scene, const SamplerCatalogue& samplers);

/// A pixel of a pilot: the mean over all chosen pixels of a quantity x is estimated by Σ weight · x.
struct PilotPixel {
  std::size_t position;  ///< among the scene's chosen pixels
  double weight;
};

/// The pixels of a pilot: all that are sampled up to 64, else 64 drawn with probabilities π that are half uniform and
/// half in proportion to `sizes` (of every chosen pixel, ≥ 0), at equal steps of their sum from a fixed random start,
/// so that they are spread over the image. A weight is hits/(64 π P), which makes the estimate unbiased (M. H. Hansen
/// and W. N. Hurwitz, "On the theory of sampling from finite populations", 1943). Few pixels may hold most of an
/// image's error, and a uniform choice would miss them.
std::vector<PilotPixel> choose_pilot_pixels(const PlannedScene& scene, std::span<const double> sizes);

/// The smallest mean squared error that is to be expected of the cells.
struct ExpectedError {
  double mse = 0;                 ///< mean over the scene's integrals; 0 where no cell shows an error
  std::string cell;               ///< whose: "balance,halton-owen,f32,1024"
  std::size_t cells = 0;          ///< that the pilot measured
  std::size_t without_error = 0;  ///< of them: no spread, or none above a hundredfold of what rounding does
};

/// Measures the variances of all cells of the pilot, which are their mean squared errors as far as they have no bias,
/// and at most that where they have. `variances` are those of any estimator of the scene's integrals, pixel-major: they
/// say where errors are to be looked for. The same for any number of threads. Throws Error(kInterrupted).
ExpectedError run_pilot(const Plan& plan, std::size_t scene, const Pilot& pilot, std::span<const double> variances,
                        const SamplerCatalogue& samplers, int threads, bool quiet);

}  // namespace halfslope
