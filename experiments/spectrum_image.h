// A measured power spectrum as an image.
#pragma once

#include <filesystem>

#include "experiments/measures.h"

namespace halfslope {

/// Power over the grid of integer frequencies (kx, ky), kx to the right and ky upwards, (0, 0) in the middle.
struct SpectrumImage {
  int width = 0, height = 0;
  std::vector<double> power;       ///< rows from the top, mean over replicates
  std::vector<double> half_width;  ///< of its 95 % t interval; 0 for one replicate
};

/// The spectrum among the means of one sampler at one N, whose rows are "spectrum:kx=…,ky=…"; empty (width 0) where
/// there is none.
SpectrumImage spectrum_image(std::span<const MeasuredMean> means);

/// Writes an EXR of 32-bit floats: channel Y the mean power over replicates, layer `half_width` the half width of its
/// interval. Error(kUsage) unless there is exactly one spectrum: of one sampler, at one N.
void write_spectrum_image(const std::filesystem::path& path, const MeasuresPlan& plan, const Measurements& measured);

}  // namespace halfslope
