#include "scenes/environment_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "core/error.h"
#include "scenes/emitters.h"

namespace halfslope {
namespace {

constexpr double kPi = std::numbers::pi;

/// Positive wherever any channel is not 0.
double weight(const float* rgb) {
  return 0.2126 * std::fabs(double{rgb[0]}) + 0.7152 * std::fabs(double{rgb[1]}) + 0.0722 * std::fabs(double{rgb[2]});
}

void check(const Bitmap& map) {
  constexpr int kMost = 1 << 16;
  const auto refuse = [&](const std::string& what) { fail(ExitCode::kBadInput, "{}: {}", map.file, what); };
  const std::string size = std::to_string(map.width) + " x " + std::to_string(map.height) + " pixels";
  if (map.width < 2 || map.height < 3) refuse("an environment map has at least 2 x 3 pixels, not " + size);
  if (map.width > kMost || map.height > kMost)
    refuse("an environment map has at most 65536 x 65536 pixels, not " + size);
  for (std::size_t i = 0; i < map.rgb.size(); ++i) {
    if (std::isfinite(map.rgb[i])) continue;
    const auto pixel = i / 3, width = static_cast<std::size_t>(map.width);
    refuse("the pixel in column " + std::to_string(pixel % width) + " of row " + std::to_string(pixel / width) +
           " is not finite");
  }
}

/// Adds the cumulative probabilities of these weights, all finite and not negative: 0 first, 1 last, multiples of
/// 1/quanta, and one quantum at least for each weight that is not 0. Where all are 0, all are equal.
template <class T>
void add_cumulative(std::span<const double> weights, std::vector<T>& out) {
  constexpr double kQuanta = sizeof(T) == 4 ? 0x1p24 : 0x1p32;
  double total = 0, positive = 0;
  for (const double w : weights) total += w, positive += w > 0 ? 1 : 0;
  const bool equal = !(total > 0);
  if (equal) total = positive = static_cast<double>(weights.size());
  double sum = 0, count = 0;
  out.push_back(T(0));
  for (const double w : weights) {
    sum += equal ? 1 : w;
    count += equal || w > 0 ? 1 : 0;
    const double reached = std::round((kQuanta - positive) * std::min(sum / total, 1.0)) + count;
    out.push_back(static_cast<T>((count == positive ? kQuanta : reached) / kQuanta));
  }
}

}  // namespace

template <class T>
EnvironmentMap<T>::EnvironmentMap(const Environment& environment) : map_(environment.map) {
  data_.scale = static_cast<T>(environment.scale);
  for (int c = 0; c < 3; ++c) data_.constant[c] = static_cast<T>(environment.radiance[c]);
  for (int i = 0; i < 9; ++i) data_.from_world[i] = static_cast<T>(environment.from_world(i / 3, i % 3));
  if (!map_) {
    const Rgb& l = environment.radiance;
    luminance_integral_ = 4 * kPi * (0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2]);
    return;
  }
  check(*map_);
  const auto width = static_cast<std::size_t>(map_->width), height = static_cast<std::size_t>(map_->height);
  const double step = kPi / static_cast<double>(height - 1);
  for (std::size_t j = 0; j < height; ++j) {
    const double s = std::sin(0.5 * step * static_cast<double>(j));
    const double c = std::sin(0.5 * step * static_cast<double>(height - 1 - j));
    half_sines_.push_back(static_cast<T>(s * s));
    half_cosines_.push_back(static_cast<T>(c * c));
  }
  // ∫ L dω over each cell: L is linear in θ between the rows of pixels, so each has a share of the row's solid angle.
  std::vector<double> cells(width * (height - 1)), angles(height - 1), nodes(2 * width);
  double total = 0;
  for (std::size_t i = 0; i < width; ++i) nodes[i] = weight(map_->rgb.data() + 3 * i);
  for (std::size_t j = 0; j + 1 < height; ++j) {
    const double top = step * static_cast<double>(j), middle = top + 0.5 * step;
    // ∫ sin θ dθ and ∫ (θ − middle) sin θ dθ over the row.
    const double band = 2 * std::sin(middle) * std::sin(0.5 * step);
    const double tilt = std::cos(middle) * (2 * std::sin(0.5 * step) - step * std::cos(0.5 * step));
    angles[j] = band * 2 * kPi / static_cast<double>(width);
    const double below = 0.5 + tilt / (band * step), above = 1 - below;
    double* here = nodes.data() + (j % 2) * width;
    double* next = nodes.data() + ((j + 1) % 2) * width;
    for (std::size_t i = 0; i < width; ++i) next[i] = weight(map_->rgb.data() + 3 * ((j + 1) * width + i));
    for (std::size_t i = 0; i < width; ++i) {
      const std::size_t right = i + 1 == width ? 0 : i + 1;
      cells[j * width + i] = angles[j] * 0.5 * (above * (here[i] + here[right]) + below * (next[i] + next[right]));
      total += cells[j * width + i];
    }
    inverse_cells_.push_back(static_cast<T>(1 / angles[j]));
  }
  luminance_integral_ = total * std::fabs(environment.scale);
  if (environment.mis_compensation) {
    // Where hardly a cell is brighter than the mean, roundings would decide; then nothing is taken away.
    const double mean = total / (4 * kPi);
    std::vector<double> rest = cells;
    double left = 0;
    for (std::size_t k = 0; k < rest.size(); ++k) {
      rest[k] = std::max(0.0, rest[k] - mean * angles[k / width]);
      left += rest[k];
    }
    if (left > 1e-6 * total) cells = std::move(rest);
  }
  std::vector<double> of_rows(height - 1);
  for (std::size_t j = 0; j + 1 < height; ++j) {
    const std::span<const double> row(cells.data() + j * width, width);
    for (const double cell : row) of_rows[j] += cell;
    add_cumulative(row, columns_);
  }
  add_cumulative<T>(of_rows, rows_);
  data_.width = map_->width, data_.height = map_->height, data_.rgb = map_->rgb.data();
  data_.rows = rows_.data(), data_.columns = columns_.data(), data_.inverse_cells = inverse_cells_.data();
  data_.half_sines = half_sines_.data(), data_.half_cosines = half_cosines_.data();
}

template class EnvironmentMap<float>;
template class EnvironmentMap<double>;

}  // namespace halfslope
