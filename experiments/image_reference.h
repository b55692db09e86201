// The image that others are measured against, and what an image must be to be measured against it.
#pragma once

#include <string>
#include <vector>

#include "analysis/image_errors.h"
#include "core/exr.h"

namespace halfslope {

/// The channels of `file` that are its image: "R", "G", "B", or "Y" where those are not there; of the layer named, or
/// without a name of the image itself or, if it has none, of the only layer that has. Throws Error(kBadInput) that
/// names what the file has instead.
std::vector<std::string> image_channels(const ExrFile& file, const std::string& layer);

/// Where a reference is from. Paths may be empty: `image` where there are halves, and the halves.
struct ReferenceFiles {
  std::string image, half_a, half_b;
  std::string layer;  ///< of the images; of the reference where it has it, else its own image
};

/// A reference read from its files. Integrals are pixel by pixel, row by row from the top-left pixel of the data
/// window, channels fastest.
struct ReferenceImage {
  std::string path;  ///< or both halves'
  int width = 0, height = 0;
  std::int64_t x = 0, y = 0;  ///< the data window's first pixel in the display window
  std::int64_t display_width = 0, display_height = 0;
  std::vector<std::string> channels;
  ImageReference values;
  std::string variance_origin;  ///< empty where the variance is not known, and taken as 0
  std::string halves_origin;    ///< empty where there are none
  double mean = 0, mean_square = 0;

  /// "ref.exr: 96 x 64 pixels, channels R, G, B; …": what is measured against, and what is known of it.
  std::string description() const;
};

/// The reference's own variance is that of its layer `variance` (`halfslope reference` writes it), or where it is the
/// mean of its halves A and B, (A − B)²/4; its halves are the layers `half_a` and `half_b`, or the two files. Throws
/// Error(kBadInput) that names a file and its problem: that of an image, halves of another shape, or a value that is
/// not finite, since nothing can be measured against it.
ReferenceImage read_reference(const ReferenceFiles& files);

/// The values of an image, in the order of the reference's. Throws Error(kBadInput) with the path and what differs
/// where size, place in the display window or channels do.
std::vector<double> read_like(const ExrFile& file, const ReferenceImage& reference, const std::string& layer);

}  // namespace halfslope
