// The figures: each draws a page (analysis/canvas.h) from its flags.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/canvas.h"
#include "experiments/catalogue.h"
#include "experiments/spec.h"

namespace halfslope {

/// Width of every page in points: that of two columns, or of the text of a book (7 inches).
inline constexpr double kPageWidth = 504;
/// Pixels of a PNG in a point: 288 to the inch.
inline constexpr int kPixelsPerPoint = 4;

/// What a figure is drawn from. Keys that were not given are empty in `spec`; each figure has defaults of its own.
struct FigureRequest {
  std::string name;
  Spec spec;  ///< scene, estimators, samplers (files of --points too), samples, seed, resolution, precision, measures
  std::uint32_t replicate = 0;
  std::optional<std::int64_t> replicates;
  std::optional<int> dims;
  std::array<int, 2> axes = {0, 1};  ///< dimensions to the right and upwards
  bool side_by_side = false;         ///< a diagram for each sampler
  std::optional<double> exposure;    ///< stops
  std::string run;                   ///< run folder
  int threads = 0;
  bool quiet = false;
};

/// What `list figures` says of one, and the flags that it takes beside --out and --quiet.
struct FigureInfo {
  std::string name, description, reference;
  std::vector<std::string> flags;
  Canvas (*draw)(const FigureRequest& request, const Catalogue& catalogue);
  bool several_counts = false;  ///< --samples may be several N
};
std::vector<FigureInfo> figure_catalogue();

/// A sampler's name as figures write it: of a file of points the last part of its path.
std::string sampler_label(const std::string& sampler);

/// The first N points of each sampler in a square, in two of their dimensions.
Canvas draw_points_figure(const FigureRequest& request, const Catalogue& catalogue);
/// `veach`: a picture of the scene by each estimator at equal N. `glossy`: by each sampler, with a part of each
/// magnified below.
Canvas draw_pictures_figure(const FigureRequest& request, const Catalogue& catalogue);
/// RMSE against N of a run folder.
Canvas draw_convergence_figure(const FigureRequest& request, const Catalogue& catalogue);
/// `work-precision`: RMSE against CPU time of a run folder.
Canvas draw_work_precision_figure(const FigureRequest& request, const Catalogue& catalogue);
/// `rates`: slopes between neighbouring N of a run folder.
Canvas draw_rates_figure(const FigureRequest& request, const Catalogue& catalogue);
/// `discrepancy`: measures of samplers' points against N.
Canvas draw_discrepancy_figure(const FigureRequest& request, const Catalogue& catalogue);
/// `pcf`: how often points lie at each distance from each other.
Canvas draw_pair_correlation_figure(const FigureRequest& request, const Catalogue& catalogue);
/// `spectrum`: a picture of each sampler's power spectrum.
Canvas draw_spectrum_figure(const FigureRequest& request, const Catalogue& catalogue);
/// `radial-spectrum`: the mean of the power over each ring of frequencies.
Canvas draw_radial_spectrum_figure(const FigureRequest& request, const Catalogue& catalogue);

}  // namespace halfslope
