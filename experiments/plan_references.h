// What the references of a plan must be, and making them so.
#pragma once

#include <string>
#include <vector>

#include "experiments/catalogue.h"
#include "experiments/plan.h"
#include "experiments/reference.h"

namespace halfslope {

/// The largest share of the smallest mean squared error of a scene's cells that the mean variance of its reference may
/// be: min(1 %, 0.25/√R), R the most replicates of a cell. What is left of the reference's error once V̄ is subtracted
/// has a standard deviation of at most √2 V̄, and the replicates' own on one integral is about √(2/R) of the error: so
/// it stays at a quarter of it, however many there are.
double reference_share(const Plan& plan, std::size_t scene);

/// The goal of a scene's reference as far as it is known without a pilot: four times the largest N of its cells, at
/// least 256, and up to 64 times that where 256 replicates would not do.
ReferenceGoal reference_goal(const Plan& plan, std::size_t scene);

/// The references of all scenes. Where one is rendered, a pilot tells what its variance may be; what is asked for, and
/// of what had no say in it, goes to stderr unless `quiet`. As make_reference, and the same for any threads and cache.
std::vector<Reference> make_references(const Plan& plan, const SamplerCatalogue& samplers,
                                       const ReferenceOptions& options);

/// What the reference of each scene will be asked for: a line a scene that has none in closed form. Renders nothing.
std::vector<std::string> describe_references(const Plan& plan, const SamplerCatalogue& samplers);

/// What the cache holds of them: lines of Plan::skips.
std::vector<std::string> describe_cached_references(const Plan& plan, const SamplerCatalogue& samplers,
                                                    const std::filesystem::path& cache);

}  // namespace halfslope
