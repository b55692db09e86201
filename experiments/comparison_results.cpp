#include "experiments/comparison_results.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>

#include "core/error.h"
#include "core/random.h"
#include "experiments/interrupt.h"
#include "experiments/parallel.h"
#include "experiments/results.h"

namespace halfslope {
namespace {

bool comparable(const CellName& a, const CellName& b) { return a.estimator == b.estimator || a.sampler == b.sampler; }

/// Pairs as indices into the family's own cells.
std::vector<ColumnPair> every_pair(const std::vector<CellResult>& cells, const std::vector<std::size_t>& family) {
  std::vector<ColumnPair> pairs = all_pairs(family.size());
  std::erase_if(pairs, [&](const ColumnPair& pair) {
    return !comparable(cells[family[pair.a]].name, cells[family[pair.b]].name);
  });
  return pairs;
}

std::vector<ColumnPair> pairs_with_first(const std::vector<CellResult>& cells, const std::vector<std::size_t>& family) {
  std::map<std::string, std::size_t> first_of_estimator, first_of_sampler;
  for (std::size_t k = 0; k < family.size(); ++k) {
    first_of_estimator.emplace(cells[family[k]].name.estimator, k);
    first_of_sampler.emplace(cells[family[k]].name.sampler, k);
  }
  std::vector<ColumnPair> pairs = every_pair(cells, family);
  std::erase_if(pairs, [&](const ColumnPair& pair) {
    const CellName& name = cells[family[pair.b]].name;
    return pair.a != first_of_estimator.at(name.estimator) && pair.a != first_of_sampler.at(name.sampler);
  });
  return pairs;
}

std::size_t replicates_of(const std::vector<CellResult>& cells, const std::vector<std::size_t>& family) {
  std::size_t most = 0;
  for (const std::size_t c : family) most = std::max(most, cells[c].replicate_mse.size());
  return most;
}

void compare_family(const std::vector<CellResult>& cells, ComparisonFamily& family) {
  std::vector<ColumnPair> pairs = every_pair(cells, family.cells);
  family.with_first_only =
      pairs.size() > kMostComparisons || pairs.size() * replicates_of(cells, family.cells) > kMostComparedReplicates;
  if (family.with_first_only) pairs = pairs_with_first(cells, family.cells);

  std::vector<ComparedErrors> errors;
  for (const std::size_t c : family.cells) {
    errors.push_back({cells[c].replicate_mse, cells[c].statistics.reference_mse, cells[c].facts.rounding_mse});
    if (cells[c].facts.infinite_variance) errors.back().squared_errors = {};
  }
  const CellName& name = cells[family.cells.front()].name;
  const auto seed = hash_text(fmt::format("{},{},{}", name.scene, name.precision, name.samples), 2);
  for (Comparison& comparison : compare(errors, pairs, seed)) {
    const std::size_t a = family.cells[comparison.pair.a], b = family.cells[comparison.pair.b];
    const auto either = [&](const char* mark) {
      return cells[a].statistics.status.find(mark) != std::string::npos ||
             cells[b].statistics.status.find(mark) != std::string::npos;
    };
    if (cells[a].facts.infinite_variance || cells[b].facts.infinite_variance) {
      comparison.status = "infinite-variance";
    } else if (comparison.log_ratio && either("heavy-tailed")) {
      comparison.status = comparison.status == "ok" ? "heavy-tailed" : comparison.status + ";heavy-tailed";
    }
    family.rows.push_back({a, b, std::move(comparison)});
  }
}

}  // namespace

std::vector<ComparisonFamily> compare_cells(const std::vector<CellResult>& cells, int threads) {
  std::vector<ComparisonFamily> families;
  std::map<std::tuple<std::string, std::string, std::uint64_t>, std::size_t> place;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const CellName& name = cells[c].name;
    const auto [found, inserted] = place.emplace(std::tuple(name.scene, name.precision, name.samples), families.size());
    if (inserted) families.emplace_back();
    families[found->second].cells.push_back(c);
  }
  with_threads(threads, [&](int) {
    tbb::parallel_for(
        std::size_t{0}, families.size(),
        [&](std::size_t f) {
          if (!interrupted()) compare_family(cells, families[f]);
        },
        tbb::simple_partitioner());
  });
  if (interrupted()) {
    fail(ExitCode::kInterrupted,
         "interrupted while cells were compared; all units are done: run the same command again to go on");
  }
  return families;
}

}  // namespace halfslope
