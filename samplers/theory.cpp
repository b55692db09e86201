#include "samplers/theory.h"

#include <algorithm>

namespace halfslope {
namespace {

using enum Regularity;

bool jumps(Regularity regularity) {
  return regularity == kJump || regularity == kAxisJump || regularity == kOneCoordinateJump;
}

bool of_one_coordinate(Regularity regularity, const Layout& layout) {
  return layout.dims() == 1 || regularity >= kOneCoordinateJump;
}

bool has_mixed_derivative(Regularity regularity) { return regularity == kMixedDerivative || regularity == kSmooth; }

// Cubical cells in `dims` dimensions, an independent point in each.
std::optional<double> cells_rate(Regularity regularity, int dims) {
  if (regularity == kSquareIntegrable) return std::nullopt;
  return -0.5 - (jumps(regularity) ? 0.5 : 1.0) / dims;
}

bool known(Regularity regularity) { return regularity != kSquareIntegrable; }

}  // namespace

std::optional<double> monte_carlo_rate(Regularity, const Layout&) { return -0.5; }

std::optional<double> grid_rate(Regularity regularity, const Layout& layout) {
  return cells_rate(regularity, layout.dims());
}

std::optional<double> grouped_grid_rate(Regularity regularity, const Layout& layout) {
  if (layout.groups.size() == 1) return cells_rate(regularity, layout.groups[0]);
  if (!known(regularity)) return std::nullopt;
  if (regularity < kOneCoordinateJump) return -0.5;
  const bool alike = std::ranges::all_of(layout.groups, [&](auto size) { return size == layout.groups[0]; });
  return alike ? cells_rate(regularity, layout.groups[0]) : std::nullopt;
}

std::optional<double> latin_rate(Regularity regularity, const Layout& layout) {
  if (!known(regularity)) return std::nullopt;
  return of_one_coordinate(regularity, layout) ? cells_rate(regularity, 1) : -0.5;
}

std::optional<double> stratified_pairs_rate(Regularity regularity, const Layout& layout) {
  if (layout.groups.size() == 1 && !of_one_coordinate(regularity, layout)) return std::nullopt;
  return latin_rate(regularity, layout);
}

std::optional<double> low_discrepancy_rate(Regularity regularity, const Layout& layout) {
  const bool finite_variation =
      has_mixed_derivative(regularity) || (known(regularity) && of_one_coordinate(regularity, layout));
  return finite_variation ? std::optional(-1.0) : std::nullopt;
}

std::optional<double> scrambled_sequence_rate(Regularity regularity, const Layout& layout) {
  if (of_one_coordinate(regularity, layout) && !jumps(regularity)) return std::nullopt;
  return low_discrepancy_rate(regularity, layout);
}

std::optional<double> scrambled_net_rate(Regularity regularity, const Layout& layout) {
  if (!known(regularity)) return std::nullopt;
  if (of_one_coordinate(regularity, layout)) return cells_rate(regularity, 1);
  if (has_mixed_derivative(regularity)) return -1.5;
  return regularity == kJump ? cells_rate(regularity, layout.dims()) : std::nullopt;
}

std::optional<double> scrambled_plane_rate(Regularity regularity, const Layout& layout) {
  return layout.dims() <= 2 ? scrambled_net_rate(regularity, layout) : scrambled_sequence_rate(regularity, layout);
}

std::optional<double> folded_lattice_rate(Regularity regularity, const Layout& layout) {
  if (regularity == kSmooth || regularity == kOneCoordinateSmooth) return -2.0;
  const bool jump = jumps(regularity) && of_one_coordinate(regularity, layout);
  return jump ? std::optional(-1.0) : std::nullopt;
}

std::optional<double> kronecker_rate(Regularity regularity, const Layout& layout) {
  return layout.dims() == 1 ? low_discrepancy_rate(regularity, layout) : std::nullopt;
}

std::optional<double> midpoint_rate(Regularity regularity, const Layout& layout) {
  if (regularity != kSmooth && regularity != kOneCoordinateSmooth) return std::nullopt;
  return -2.0 / layout.dims();
}

}  // namespace halfslope
