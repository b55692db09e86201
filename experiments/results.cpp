#include "experiments/results.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "core/error.h"
#include "experiments/interrupt.h"
#include "experiments/parallel.h"

namespace halfslope {
namespace {

CellFacts facts_of(const Plan& plan, const Cell& cell, const Reference& reference, const SamplerCatalogue& samplers) {
  const IntegralSource& source = *plan.scenes[cell.scene].source;
  CellFacts facts;
  facts.deterministic = !plan.passes[cell.pass].randomised;
  facts.infinite_variance = has_infinite_variance(source);
  // Values are as large as their root mean square, however small their mean.
  const double unit = cell.precision == Precision::kF32 ? 0x1p-24 : 0x1p-53, known = source.variance().value_or(0);
  facts.rounding_mse = unit * unit * (reference.mean * reference.mean + (std::isfinite(known) ? known : 0));
  const SamplerInfo info = samplers.make(cell.sampler)->info();
  facts.unbiased = info.unbiased;
  // What another technique integrates, f over its density, is as smooth as nobody said.
  const bool plain = source.techniques().size() == 1;
  const Regularity regularity = plain ? source.regularity() : Regularity::kSquareIntegrable;
  if (info.rate) facts.theory = info.rate(regularity, plan.passes[cell.pass].allocation.layout(source.techniques()));
  return facts;
}

CellResult result_of(const Plan& plan, const Cell& cell, FoldedCell& folded, const CellFacts& facts,
                     const ReferenceShares& shares) {
  const PlannedScene& scene = plan.scenes[cell.scene];
  CellResult result;
  result.name = cell_name(plan, cell);
  result.replicates = plan.passes[cell.pass].replicates;
  result.pixels = static_cast<std::int64_t>(scene.pixels.size());
  result.facts = facts;
  folded.data.rounding_mse = facts.rounding_mse;
  result.statistics = summarise(folded.data);
  result.mse = folded.data.mse.mean;
  result.reference_mse_variance = folded.data.reference_mse_noise;
  for (const ReplicateErrors& errors : folded.data.per_replicate) {
    result.replicate_mse.push_back(errors.mse);
    result.replicate_variance.push_back(errors.variance);
  }
  result.regions = region_results(scene, folded, result.statistics, shares);
  result.first_bad_replicate = folded.first_bad_replicate;
  result.first_bad_pixel = folded.first_bad_pixel;
  return result;
}

}  // namespace

Results collect_results(const Plan& plan, std::span<const Reference> references, const Journal& journal,
                        const SamplerCatalogue& samplers, int threads, const CellVisitor& visitor) {
  Results results;
  results.cells.resize(plan.cells.size());
  std::vector<ReferenceShares> shares;
  for (std::size_t s = 0; s < plan.scenes.size(); ++s)
    shares.push_back(reference_shares(plan.scenes[s], references[s]));
  const auto same_line = [&](std::size_t a, std::size_t b) {
    const Cell &x = plan.cells[a], &y = plan.cells[b];
    return x.scene == y.scene && x.estimator == y.estimator && x.sampler == y.sampler && x.precision == y.precision;
  };
  // A line of convergence at a time, so that no more of them than that are held whole.
  for (std::size_t begin = 0, end = 0; begin < plan.cells.size(); begin = end) {
    if (interrupted()) {
      fail(ExitCode::kInterrupted,
           "interrupted while the tables were made; all units are done: run the same command again to go on");
    }
    while (end < plan.cells.size() && same_line(begin, end)) ++end;
    const CellFacts facts = facts_of(plan, plan.cells[begin], references[plan.cells[begin].scene], samplers);
    std::vector<FoldedCell> line(end - begin);
    with_threads(threads, [&](int) {
      tbb::parallel_for(
          begin, end,
          [&](std::size_t c) {
            const Cell& cell = plan.cells[c];
            FoldedCell& folded = line[c - begin] =
                fold_cell(plan, cell, references[cell.scene], journal, plan.passes[cell.pass].replicates);
            visitor.as_folded(cell, folded);
            results.cells[c] = result_of(plan, cell, folded, facts, shares[cell.scene]);
            folded.integrals = {};
            folded.regions = {};
          },
          tbb::simple_partitioner());
    });
    for (std::size_t c = begin; c < end; ++c) visitor.in_order(plan.cells[c], line[c - begin]);
  }
  RateResults fitted = fit_rates(results.cells, threads);
  results.rates = std::move(fitted.rates);
  results.local_rates = std::move(fitted.local);
  return results;
}

}  // namespace halfslope
