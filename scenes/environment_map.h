// Light from all around, inside a kernel: looked up, sampled in proportion to its luminance, and the density of that.
//
// As in Mitsuba's envmap, the pixels of a map are nodes of a grid and radiance is bilinear between them: column i at
// azimuth (i + ½)/width of a turn, around which the columns wrap, and row j at polar angle π j/(height − 1), the first
// and the last at the poles. Each cell of that grid has one density, in solid angle: its mean luminance. That is
// positive wherever radiance is, and it is finite at the poles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "core/packet.h"
#include "scenes/vec.h"
#include "scenes/warp.h"

namespace halfslope {

struct Bitmap;
struct Environment;

/// What kernels read. The cumulative probabilities are multiples of 2⁻²⁴ (float) or 2⁻³² (double), as coordinates are,
/// so that a cell is drawn exactly as often as its density says.
template <class T>
struct EnvironmentMapData {
  int width, height;       ///< in pixels; 0 of a constant environment
  const float* rgb;        ///< rows from the top, 3 a pixel
  const T* rows;           ///< height: the probability of all rows of cells above each
  const T* columns;        ///< height − 1 rows of width + 1: likewise of the cells of a row left of each
  const T* half_sines;     ///< sin²(θ/2) at each row of pixels
  const T* half_cosines;   ///< cos²(θ/2)
  const T* inverse_cells;  ///< height − 1: 1 over the solid angle of a row's cells
  T scale;                 ///< of rgb
  T constant[3];           ///< the radiance where width = 0
  T from_world[9];         ///< rows of the rotation into the map's own axes
};

/// A direction drawn, unit length; its density in 1/sr; and the radiance from there.
template <class F>
struct EnvironmentSample {
  Vec<F> direction;
  F pdf;
  F radiance[3];
};

namespace environment {

/// A cell for each lane, and the place in it.
template <class F>
struct Cell {
  static constexpr std::size_t kLanes = static_cast<std::size_t>(kWidth<F>);
  std::int32_t column[kLanes], row[kLanes];
  F right, down;  ///< in [0, 1]
};

template <class F>
inline void to_integers(const F& x, std::int32_t* out) {
  alignas(64) scalar_t<F> lanes[static_cast<std::size_t>(kWidth<F>)];
  store(lanes, x);
  for (std::size_t l = 0; l < static_cast<std::size_t>(kWidth<F>); ++l) out[l] = static_cast<std::int32_t>(lanes[l]);
}

/// read(l) of every lane l.
template <class F, class Read>
inline F each_lane(const Read& read) {
  alignas(64) scalar_t<F> lanes[static_cast<std::size_t>(kWidth<F>)];
  for (std::size_t l = 0; l < static_cast<std::size_t>(kWidth<F>); ++l) lanes[l] = read(l);
  return load<F>(lanes);
}

template <class F>
inline Vec<F> to_map(const EnvironmentMapData<scalar_t<F>>& map, const Vec<F>& d) {
  const auto row = [&](int i) {
    return fma(F(map.from_world[i]), d.x, fma(F(map.from_world[i + 1]), d.y, F(map.from_world[i + 2]) * d.z));
  };
  return {row(0), row(3), row(6)};
}

template <class F>
inline Vec<F> to_world(const EnvironmentMapData<scalar_t<F>>& map, const Vec<F>& d) {
  const auto column = [&](int i) {
    return fma(F(map.from_world[i]), d.x, fma(F(map.from_world[i + 3]), d.y, F(map.from_world[i + 6]) * d.z));
  };
  return {column(0), column(1), column(2)};
}

/// The cell that a direction, of any length but 0, points to.
template <class F>
inline Cell<F> cell_of(const EnvironmentMapData<scalar_t<F>>& map, const Vec<F>& direction) {
  using T = scalar_t<F>;
  const F zero(T(0)), one(T(1)), width(static_cast<T>(map.width)), last(static_cast<T>(map.height - 2));
  const Vec<F> d = to_map(map, direction);
  const F turns = arctan2(d.x, -d.z) * F(T(0.5) * std::numbers::inv_pi_v<T>);  // in [−½, ½]
  const F x = fma(turns, width, F(T(-0.5))), around = select(x < zero, x + width, x);
  const F y = arctan2(sqrt(fma(d.x, d.x, d.z * d.z)), d.y) * F(std::numbers::inv_pi_v<T>) * (last + one);
  const F column = min(floor_positive(max(around, zero)), width - one), row = min(floor_positive(y), last);
  Cell<F> cell;
  to_integers(column, cell.column);
  to_integers(row, cell.row);
  cell.right = min(max(around - column, zero), one);
  cell.down = min(y - row, one);
  return cell;
}

template <class F>
inline void radiance_of(const EnvironmentMapData<scalar_t<F>>& map, const Cell<F>& cell, F* radiance) {
  using T = scalar_t<F>;
  const auto pixel = [&](std::size_t l, int right, int down, std::size_t channel) {
    const int column = cell.column[l] + right;
    const auto at = static_cast<std::size_t>(cell.row[l] + down) * static_cast<std::size_t>(map.width) +
                    static_cast<std::size_t>(column == map.width ? 0 : column);
    return static_cast<T>(map.rgb[3 * at + channel]);
  };
  const F left = F(T(1)) - cell.right, up = F(T(1)) - cell.down;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const auto node = [&](int right, int down) {
      return each_lane<F>([&](std::size_t l) { return pixel(l, right, down, channel); });
    };
    const F above = fma(left, node(0, 0), cell.right * node(1, 0));
    const F below = fma(left, node(0, 1), cell.right * node(1, 1));
    radiance[channel] = F(map.scale) * fma(up, above, cell.down * below);
  }
}

template <class F>
inline F pdf_of(const EnvironmentMapData<scalar_t<F>>& map, const Cell<F>& cell) {
  return each_lane<F>([&](std::size_t l) {
    const auto row = static_cast<std::size_t>(cell.row[l]);
    const auto* columns =
        map.columns + row * static_cast<std::size_t>(map.width + 1) + static_cast<std::size_t>(cell.column[l]);
    return (map.rows[row + 1] - map.rows[row]) * (columns[1] - columns[0]) * map.inverse_cells[row];
  });
}

/// The interval [edges[i], edges[i + 1]) that holds x; edges[0] = 0 ≤ x < edges[count] = 1.
template <class T>
inline std::int32_t interval_of(const T* edges, std::int32_t count, T x) {
  std::int32_t low = 0, high = count;
  while (high - low > 1) {
    const std::int32_t middle = low + (high - low) / 2;
    (x < edges[middle] ? high : low) = middle;
  }
  return low;
}

}  // namespace environment

/// The radiance that arrives along the ray with this unit direction, seen from where the ray starts: 3 channels.
template <class F>
inline void environment_radiance(const EnvironmentMapData<scalar_t<F>>& map, const Vec<F>& direction, F* radiance) {
  if (map.width == 0) {
    for (int c = 0; c < 3; ++c) radiance[c] = F(map.constant[c]);
    return;
  }
  environment::radiance_of(map, environment::cell_of(map, direction), radiance);
}

/// The density in 1/sr with which sample_environment draws this direction.
template <class F>
inline F environment_pdf(const EnvironmentMapData<scalar_t<F>>& map, const Vec<F>& direction) {
  using T = scalar_t<F>;
  if (map.width == 0) return F(T(0.25) * std::numbers::inv_pi_v<T>);
  return environment::pdf_of(map, environment::cell_of(map, direction));
}

/// A direction drawn with u₁, u₂ in [0, 1): u₂ chooses the row of cells and the place in it, from the top, u₁ the
/// column, both by inversion, so that neighbours stay neighbours. In a cell cos θ and the azimuth are uniform. A
/// constant environment is sampled uniformly.
template <class F>
inline EnvironmentSample<F> sample_environment(const EnvironmentMapData<scalar_t<F>>& map, const F& u1, const F& u2) {
  using T = scalar_t<F>;
  EnvironmentSample<F> sample;
  if (map.width == 0) {
    sample.direction = uniform_sphere(u1, u2);
    sample.pdf = F(T(0.25) * std::numbers::inv_pi_v<T>);
    for (int c = 0; c < 3; ++c) sample.radiance[c] = F(map.constant[c]);
    return sample;
  }
  constexpr auto kPacketLanes = static_cast<std::size_t>(kWidth<F>);
  alignas(64) T x[kPacketLanes], y[kPacketLanes], column[kPacketLanes], row[kPacketLanes];
  store(x, u1), store(y, u2);
  environment::Cell<F> cell;
  for (std::size_t l = 0; l < kPacketLanes; ++l) {
    const std::int32_t j = environment::interval_of(map.rows, map.height - 1, y[l]);
    const T* columns = map.columns + static_cast<std::size_t>(j) * static_cast<std::size_t>(map.width + 1);
    const std::int32_t i = environment::interval_of(columns, map.width, x[l]);
    cell.row[l] = j, cell.column[l] = i;
    y[l] = (y[l] - map.rows[j]) / (map.rows[j + 1] - map.rows[j]);
    x[l] = (x[l] - columns[i]) / (columns[i + 1] - columns[i]);
    column[l] = static_cast<T>(i), row[l] = static_cast<T>(j);
  }
  cell.right = load<F>(x);
  const F down = load<F>(y), zero(T(0)), one(T(1));
  const auto between = [&](const T* values) {
    const F above = environment::each_lane<F>([&](std::size_t l) { return values[cell.row[l]]; });
    return fma(down, environment::each_lane<F>([&](std::size_t l) { return values[cell.row[l] + 1]; }) - above, above);
  };
  const F half_sine = between(map.half_sines), half_cosine = between(map.half_cosines);
  const F theta = F(T(2)) * arctan2(sqrt(half_sine), sqrt(half_cosine));
  cell.down =
      min(max(fma(theta, F(static_cast<T>(map.height - 1) * std::numbers::inv_pi_v<T>), -load<F>(row)), zero), one);
  const F turns = (load<F>(column) + cell.right + F(T(0.5))) / F(static_cast<T>(map.width));
  const auto azimuth = sin_cos_2pi(select(turns >= one, turns - one, turns));
  const F sin_theta = F(T(2)) * sqrt(half_sine * half_cosine);
  const Vec<F> d = {azimuth.sin * sin_theta, half_cosine - half_sine, -(azimuth.cos * sin_theta)};
  sample.direction = environment::to_world(map, d);
  sample.pdf = environment::pdf_of(map, cell);
  environment::radiance_of(map, cell, sample.radiance);
  return sample;
}

/// The tables behind an EnvironmentMapData, made in time and memory proportional to the map's pixels.
template <class T>
class EnvironmentMap {
 public:
  /// Throws Error(kBadInput) for a map that has fewer than 2 × 3 pixels, as Mitsuba, or more than 2¹⁶ × 2¹⁶, or a pixel
  /// that is not finite.
  explicit EnvironmentMap(const Environment& environment);
  EnvironmentMap(const EnvironmentMap&) = delete;
  EnvironmentMap& operator=(const EnvironmentMap&) = delete;

  const EnvironmentMapData<T>& data() const { return data_; }
  /// ∫ L dω over all directions, L the luminance 0.2126 R + 0.7152 G + 0.0722 B.
  double luminance_integral() const { return luminance_integral_; }

 private:
  EnvironmentMapData<T> data_ = {};
  std::shared_ptr<const Bitmap> map_;
  std::vector<T> rows_, columns_, half_sines_, half_cosines_, inverse_cells_;
  double luminance_integral_ = 0;
};

extern template class EnvironmentMap<float>;
extern template class EnvironmentMap<double>;

}  // namespace halfslope
