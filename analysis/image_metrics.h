// Metrics of linear images, each by a name and a version that stand for one formula.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/cell_statistics.h"
#include "analysis/reference_noise.h"

namespace halfslope {

/// What a metric takes the mean of.
enum class MetricKind {
  kSquared,   ///< (I − R)² · weight(R): a noisy reference adds mean Var(R) · weight(R), which is subtracted
  kRooted,    ///< the root of that mean
  kAbsolute,  ///< |I − R| / scale(I, R), in which the reference's noise stays
};

/// A metric of an image I against a reference R, linear values without any tone curve: the mean over pixels and
/// channels alike (so each channel weighs the same, and it is the mean of the channels' own values) of one term, then
/// over replicates. `version` grows when the formula changes, so name and version together are what to quote.
struct ImageMetric {
  std::string_view name;
  int version;
  MetricKind kind;
  std::string_view formula;    ///< of one value
  std::string_view reference;  ///< where it is from
  double (*term)(double image, double reference);
  double (*weight)(double reference);  ///< of a squared or rooted metric, else null
};

/// All metrics. To add one: a line in this table's definition.
std::span<const ImageMetric> image_metrics();

/// A metric of a cell with its 95 % interval over replicates. Empty where a number is not finite or, less the
/// reference's share, not positive; never 0 instead.
struct MetricValue {
  std::optional<double> value, lo, hi;
  std::optional<double> reference_share;  ///< what was subtracted; empty for a metric from which nothing can be
};

/// Of `replicates`, the metric's mean over each image, for a squared one before any root. The interval is that of log
/// of their mean by log_mean_bootstrap_t, widened_for_reference, less the reference's share; `exact` says that all
/// errors are known to be 0.
MetricValue metric_value(const ImageMetric& metric, std::span<const double> replicates, const ReferencePart& reference,
                         bool exact, std::uint64_t seed);

/// The metrics that a cell's statistics have already, by their very numbers: `mse`, `rmse` and `relmse` of them.
std::optional<MetricValue> metric_of(const ImageMetric& metric, const CellData& data, const CellStatistics& statistics);

}  // namespace halfslope
