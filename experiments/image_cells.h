// From the files of a pattern to cells, and from seeds to pairs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/image_pattern.h"
#include "experiments/image_results.h"

namespace halfslope {

/// The files of one cell.
struct CellFiles {
  struct Image {
    std::uint64_t seed;
    std::filesystem::path path;
  };
  CellName name;
  std::vector<Image> images;  ///< by seed
};

/// Cells in the order of tables: scene, precision, estimator, sampler, N, each ascending. A second image of one cell
/// and seed is left out and named in `problems`.
std::vector<CellFiles> group_by_cell(const std::vector<ImageFile>& files, std::vector<ImageProblem>& problems);

/// One problem for each cell that lacks seeds which other cells of its scene and precision have. A line all of whose
/// cells have one image lacks none: it is deterministic, or has no seeds in its names.
std::vector<ImageProblem> missing_seeds(const std::vector<CellFiles>& cells, const ImagePattern& pattern);

/// Sets the replicates' squared errors of each cell to those of the seeds that all cells of its scene and precision
/// with several replicates have; where fewer than two are common, of those of its line; where the line has fewer than
/// two either, its first replicates, as many as each cell of the line has, which then are paired as they come.
void pair_replicates(Results& results, const std::vector<ImageCell>& cells);

}  // namespace halfslope
