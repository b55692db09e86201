#include "analysis/measure_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/neighbours.h"

namespace halfslope {
namespace {

constexpr const char* kTwoPoints = "it needs two points";
constexpr const char* kTwoDims = "it takes points of 2 dimensions";

}  // namespace

std::string too_much(double steps, double bytes) {
  if (bytes > kMostBytes)
    return fmt::format("it would take {:.3g} GB of memory, and takes at most {:g}", bytes / 1e9, kMostBytes / 1e9);
  if (steps > kMostSteps) return fmt::format("it would take {:.2g} steps, and takes at most {:g}", steps, kMostSteps);
  return {};
}

std::string neighbours_refusal(std::size_t count, std::size_t dims) {
  if (count < 2) return kTwoPoints;
  const auto n = static_cast<double>(count), d = static_cast<double>(dims);
  const bool tree = dims <= NeighbourSearch::kMostDims;
  return too_much(tree ? 0 : n * n * d / 2, tree ? n * (16 * d + 64) : n * 8);
}

std::string dispersion_refusal(std::size_t count, std::size_t dims) {
  if (dims != 2) return kTwoDims;
  return too_much(0, static_cast<double>(count) * 100);
}

std::string pairs_refusal(std::size_t count, std::size_t dims, double most, int bins) {
  if (count < 2) return kTwoPoints;
  const auto n = static_cast<double>(count), d = static_cast<double>(dims);
  return too_much(n * n / 2 * std::min(1.0, dims == 1 ? 2 * most : 6 * most * most) * d,
                  n * (8 * d + 24) + 40.0 * bins);
}

std::string spectrum_refusal(std::size_t count, std::size_t dims, int most) {
  if (dims != 2) return kTwoDims;
  return too_much(static_cast<double>(count) * 4 * std::pow(most + 1, 2), 0);
}

}  // namespace halfslope
