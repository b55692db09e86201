#include "experiments/spectrum_image.h"

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "core/exr.h"

namespace halfslope {

SpectrumImage spectrum_image(std::span<const MeasuredMean> means) {
  struct Entry {
    int kx, ky;
    const MeasuredMean* mean;
  };
  std::vector<Entry> entries;
  int left = 0, right = 0, bottom = 0, top = 0;
  for (const MeasuredMean& mean : means) {
    Entry entry{0, 0, &mean};
    if (std::sscanf(mean.name.c_str(), "spectrum:kx=%d,ky=%d", &entry.kx, &entry.ky) != 2) continue;
    left = std::min(left, entry.kx);
    right = std::max(right, entry.kx);
    bottom = std::min(bottom, entry.ky);
    top = std::max(top, entry.ky);
    entries.push_back(entry);
  }
  if (entries.empty()) return {};
  SpectrumImage image{right - left + 1, top - bottom + 1, {}, {}};
  image.power.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  image.half_width.resize(image.power.size());
  for (const Entry& entry : entries) {
    const auto at = static_cast<std::size_t>((top - entry.ky) * image.width + entry.kx - left);
    image.power[at] = entry.mean->value;
    image.half_width[at] = (entry.mean->upper - entry.mean->lower) / 2;
  }
  return image;
}

void write_spectrum_image(const std::filesystem::path& path, const MeasuresPlan& plan, const Measurements& measured) {
  const std::vector<MeasuredMean> means = measured_means(plan, measured);
  const bool one = plan.points.size() == 1 && plan.points.front().counts.size() == 1;
  const SpectrumImage spectrum = one ? spectrum_image(means) : SpectrumImage{};
  if (spectrum.width == 0) {
    fail(ExitCode::kUsage,
         "--exr: an image is of one spectrum; give one --sampler or file, one --count and --measures spectrum");
  }
  const auto floats = [](const std::vector<double>& values) {
    return std::vector<float>(values.begin(), values.end());
  };
  ExrImage image{spectrum.width, spectrum.height, {}};
  image.channels.push_back({"Y", floats(spectrum.power)});
  image.channels.push_back({"half_width.Y", floats(spectrum.half_width)});
  write_exr(path, image);
}

}  // namespace halfslope
