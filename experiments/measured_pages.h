// Pages drawn from means of measures over replicates, whoever measured them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/rates.h"
#include "experiments/line_page.h"
#include "experiments/measures.h"

namespace halfslope {

/// The lines of curves: of each sampler at each N, the means named `prefix` + x, such as "pcf:r=0.125", where x is
/// multiplied by unit(N). An interval without width is none.
std::vector<ChartLine> curve_lines(const std::vector<MeasuredMean>& means, const std::string& prefix,
                                   double (*unit)(const MeasuredMean& mean));

/// Pair correlation over r · N^(1/d), from rows "pcf:r=…". `side_by_side`: a chart for each line, as always where they
/// are more than the looks.
LinePage pair_correlation_page(const std::vector<MeasuredMean>& means, bool side_by_side);

/// Radial mean power over the frequency f, from rows "radial-spectrum:f=…"; beside it the anisotropy, where there are
/// rows "anisotropy:f=…". Where N differ, over f/√N.
LinePage radial_spectrum_page(const std::vector<MeasuredMean>& means, bool side_by_side);

/// How fast the mean over replicates of a measure falls with N: ordinary least squares of its logarithm.
struct MeasuredSlope {
  const MeasuredPoints* points;
  std::string measure;
  RateFit fit;
};
std::vector<MeasuredSlope> measured_slopes(const MeasuresPlan& plan, const Measurements& measured);

/// Each measure against N, both logarithmic, a chart for each measure and up to eight samplers.
LinePage discrepancy_page(const std::vector<MeasuredMean>& means, const std::vector<MeasuredSlope>& slopes);

/// A picture of each sampler's power spectrum, from rows "spectrum:kx=…,ky=…". `subtitle` is part of the caption.
Canvas spectrum_page(const std::vector<MeasuredMean>& means, const std::string& subtitle);

}  // namespace halfslope
