#include "experiments/image_cells.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "experiments/joined.h"

namespace halfslope {
namespace {

using Seeds = std::set<std::uint64_t>;

auto table_order(const CellName& name) {
  return std::tie(name.scene, name.precision, name.estimator, name.sampler, name.samples);
}

bool same_table(const CellName& a, const CellName& b) { return a.scene == b.scene && a.precision == b.precision; }

bool together(const std::vector<std::uint64_t>& common) { return common.size() >= 2; }

/// The seeds that each of the cells has.
std::vector<std::uint64_t> common_seeds(const std::vector<const ImageCell*>& cells) {
  std::vector<std::uint64_t> common;
  for (const ImageCell* cell : cells) {
    if (cell == cells.front()) {
      common = cell->seeds;
    } else {
      std::erase_if(common, [&](std::uint64_t seed) { return !std::ranges::binary_search(cell->seeds, seed); });
    }
  }
  return common;
}

std::vector<double> errors_at(const ImageCell& cell, const std::vector<std::uint64_t>& seeds) {
  std::vector<double> mse;
  for (const std::uint64_t seed : seeds) {
    const auto at = std::ranges::lower_bound(cell.seeds, seed) - cell.seeds.begin();
    mse.push_back(cell.replicates[static_cast<std::size_t>(at)].mse);
  }
  return mse;
}

void pair_line(Results& results, const std::vector<ImageCell>& cells, std::size_t begin, std::size_t end,
               const std::vector<std::uint64_t>& of_table) {
  std::vector<const ImageCell*> line;
  std::size_t fewest = cells[begin].seeds.size();
  for (std::size_t c = begin; c < end; ++c) {
    line.push_back(&cells[c]);
    fewest = std::min(fewest, cells[c].seeds.size());
  }
  const std::vector<std::uint64_t> of_line = common_seeds(line);
  // A line with a single replicate is no part of what the table's common seeds were made from.
  const bool use_table = together(of_table) && fewest >= 2, use_line = together(of_line);
  for (std::size_t c = begin; c < end; ++c) {
    const std::vector<std::uint64_t> first(cells[c].seeds.begin(),
                                           cells[c].seeds.begin() + static_cast<std::ptrdiff_t>(fewest));
    results.cells[c].replicate_mse = errors_at(cells[c], use_table ? of_table : use_line ? of_line : first);
  }
}

}  // namespace

std::vector<CellFiles> group_by_cell(const std::vector<ImageFile>& files, std::vector<ImageProblem>& problems) {
  std::vector<CellFiles> cells;
  std::vector<const ImageFile*> sorted;
  for (const ImageFile& file : files) sorted.push_back(&file);
  std::stable_sort(sorted.begin(), sorted.end(), [](const ImageFile* a, const ImageFile* b) {
    return std::tuple(table_order(a->name), a->seed) < std::tuple(table_order(b->name), b->seed);
  });
  for (const ImageFile* file : sorted) {
    if (cells.empty() || !(cells.back().name == file->name)) cells.push_back({file->name, {}});
    auto& images = cells.back().images;
    const std::uint64_t seed = file->seed.value_or(0);
    if (!images.empty() && images.back().seed == seed) {
      problems.push_back({file->path.string(), fmt::format("is the same cell{} as {}, and left out",
                                                           file->seed ? fmt::format(" and seed {}", seed) : "",
                                                           images.back().path.string())});
      continue;
    }
    images.push_back({seed, file->path});
  }
  return cells;
}

std::vector<ImageProblem> missing_seeds(const std::vector<CellFiles>& cells, const ImagePattern& pattern) {
  constexpr std::size_t kMostNamed = 5;
  std::vector<ImageProblem> problems;
  if (!pattern.has("seed")) return problems;
  std::map<std::pair<std::string, std::string>, Seeds> of_table;  // by scene and precision
  std::map<std::string, bool> several;                            // whether a line has more than one image at some N
  for (const CellFiles& cell : cells) {
    if (cell.images.size() > 1) several[line_text(cell.name)] = true;
  }
  for (const CellFiles& cell : cells) {
    if (!several.contains(line_text(cell.name))) continue;
    for (const auto& image : cell.images) of_table[{cell.name.scene, cell.name.precision}].insert(image.seed);
  }
  for (const CellFiles& cell : cells) {
    if (!several.contains(line_text(cell.name))) continue;
    Seeds missing = of_table[{cell.name.scene, cell.name.precision}];
    for (const auto& image : cell.images) missing.erase(image.seed);
    if (missing.empty()) continue;
    std::vector<std::string> named;
    for (const std::uint64_t seed : missing) {
      if (named.size() < kMostNamed) named.push_back(std::to_string(seed));
    }
    problems.push_back(
        {pattern.path_of(cell.name, *missing.begin()),
         fmt::format("is missing: N = {} of estimator {}, sampler {} lacks {} {}{}, which others have",
                     cell.name.samples, cell.name.estimator, cell.name.sampler,
                     missing.size() == 1 ? "seed" : "the seeds", joined(named),
                     missing.size() > kMostNamed ? fmt::format(" and {} more", missing.size() - kMostNamed) : "")});
  }
  return problems;
}

void pair_replicates(Results& results, const std::vector<ImageCell>& cells) {
  for (std::size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
    while (end < cells.size() && same_table(results.cells[begin].name, results.cells[end].name)) ++end;
    std::vector<const ImageCell*> several;
    for (std::size_t c = begin; c < end; ++c) {
      if (cells[c].seeds.size() > 1) several.push_back(&cells[c]);
    }
    const std::vector<std::uint64_t> of_table = common_seeds(several);
    for (std::size_t from = begin, to = begin; from < end; from = to) {
      while (to < end && same_line(results.cells[from].name, results.cells[to].name)) ++to;
      pair_line(results, cells, from, to, of_table);
    }
  }
}

}  // namespace halfslope
