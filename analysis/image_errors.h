// Errors of whole images against a reference, one image at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/cell_statistics.h"
#include "analysis/image_metrics.h"

namespace halfslope {

/// What images are measured against: R̂_p of P integrals, pixel-major, channels fastest.
struct ImageReference {
  std::size_t channels = 1;
  std::vector<double> value;
  std::vector<double> variance;        ///< Var(R̂_p); empty: not known, and taken as 0
  std::vector<double> half_a, half_b;  ///< two independent estimates of the same integrals; empty: none

  double mean_variance() const;  ///< V̄; 0 where it is not known
};

/// The sums of a cell, from images that each are a replicate. Holds the fourth-order moments of every integral and a
/// few numbers for each image, never an image.
class ImageErrors {
 public:
  /// Keeps the reference by address; its vectors that are not empty have one length.
  explicit ImageErrors(const ImageReference& reference);

  /// One more replicate, as long as the reference. A non-finite value is counted and stays in every sum, which it makes
  /// non-finite.
  void add(std::span<const double> image);

  /// What the images so far make of the cell: the sums that a run's replicates give (experiments/fold.h).
  /// `reference_se` takes the reference's pixels as independent, and the channels of one pixel as rising and falling
  /// together, since they share samples: √(Σ_pixels (Σ_channels √V)²)/P. At least one image.
  CellData data(std::uint64_t bootstrap_seed) const;

  /// The values of image_metrics(), in its order; those that `statistics`, of data(), has are its numbers.
  std::vector<MetricValue> metrics(const CellData& data, const CellStatistics& statistics) const;

  /// The mean squared error that the reference's halves show (analysis/half_buffers.h); empty where it has none.
  std::optional<MetricValue> half_buffers(std::uint64_t seed) const;

 private:
  ReferencePart share(double (*weight)(double)) const;

  const ImageReference& reference_;
  std::vector<Moments> integrals_;
  std::vector<ReplicateErrors> replicates_;
  std::vector<std::vector<double>> metrics_;  ///< [metric][image]
  std::vector<double> half_buffer_mse_;
  LogHistogram abs_error_;
  std::int64_t nonfinite_ = 0;
};

}  // namespace halfslope
