// Every way in which the weights of heuristics can be computed: the template over each number type of this build, and
// the fold of each instruction set.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "core/point_block.h"
#include "estimators/heuristics.h"
#include "tests/estimators/isa_scope.h"

namespace halfslope {

inline constexpr Heuristic kAverage = {HeuristicKind::kAverage, 0}, kBalance = {HeuristicKind::kBalance, 0};
inline constexpr double kBetas[] = {0.5, 1, 2, 3, 4, 7.3, 1000};

inline constexpr double kAlphas[] = {0, 0.1, 0.5, 0.8, 1};
inline constexpr Heuristic kMaximum = {HeuristicKind::kMaximum, 0};

inline Heuristic power(double beta) { return {HeuristicKind::kPower, beta}; }
inline Heuristic cutoff(double alpha) { return {HeuristicKind::kCutoff, alpha}; }

inline std::vector<Heuristic> every_heuristic() {
  std::vector<Heuristic> all = {kAverage, kBalance};
  for (const double beta : kBetas) all.push_back(power(beta));
  for (const double alpha : kAlphas) all.push_back(cutoff(alpha));
  all.push_back(kMaximum);
  return all;
}

inline std::string name(const Heuristic& h) {
  switch (h.kind) {
    case HeuristicKind::kAverage:
      return "average";
    case HeuristicKind::kBalance:
      return "balance";
    case HeuristicKind::kPower:
      return "power:" + std::to_string(h.parameter);
    case HeuristicKind::kCutoff:
      return "cutoff:" + std::to_string(h.parameter);
    case HeuristicKind::kMaximum:
      return "maximum";
    default:
      return "custom";
  }
}

/// [technique][point]; the number of points is a multiple of kLanes.
template <class T>
using Table = std::vector<std::vector<T>>;

/// A way to compute weights: every technique's weight at every point, from every technique's density there.
template <class T>
struct Way {
  std::string name;
  std::function<Table<T>(const Heuristic&, const Table<T>& densities)> weights;
};

template <class F>
Way<scalar_t<F>> by_template(const std::string& type) {
  using T = scalar_t<F>;
  return {type, [](const Heuristic& heuristic, const Table<T>& densities) {
            const int n = static_cast<int>(densities.size());
            Table<T> weights = densities;
            alignas(64) T lanes[64];
            for (std::size_t p = 0; p < densities[0].size(); p += static_cast<std::size_t>(kWidth<F>)) {
              F ratios[8];
              for (std::size_t k = 0; k < densities.size(); ++k) {
                for (std::size_t l = 0; l < static_cast<std::size_t>(kWidth<F>); ++l) lanes[l] = densities[k][p + l];
                ratios[k] = load<F>(lanes);
              }
              to_ratios(ratios, n);
              for (std::size_t i = 0; i < densities.size(); ++i) {
                store(lanes, weight(heuristic, ratios, n, static_cast<int>(i)));
                for (std::size_t l = 0; l < static_cast<std::size_t>(kWidth<F>); ++l) weights[i][p + l] = lanes[l];
              }
            }
            return weights;
          }};
}

/// What `fold` makes of a round: `values` and `counts` by technique, slots[q] the technique of slot q, one channel.
template <class T>
std::vector<T> folded(Isa isa, const std::vector<Heuristic>& heuristics, const Table<T>& densities,
                      const std::vector<int>& slots, const Table<T>& values, const std::vector<T>& counts) {
  const std::size_t stride = densities[0].size(), rows = 1 + densities.size();
  AlignedBuffer<T> terms(slots.size() * rows * stride), out(heuristics.size() * stride);
  for (std::size_t q = 0; q < slots.size(); ++q) {
    for (std::size_t p = 0; p < stride; ++p) {
      terms[q * rows * stride + p] = values[q][p];
      for (std::size_t k = 0; k < densities.size(); ++k) terms[(q * rows + 1 + k) * stride + p] = densities[k][p];
    }
  }
  std::vector<T*> outputs;
  for (std::size_t h = 0; h < heuristics.size(); ++h) outputs.push_back(out.data() + h * stride);
  const FoldCall<T> call = {terms.data(),
                            stride,
                            stride,
                            static_cast<int>(slots.size()),
                            1,
                            static_cast<int>(densities.size()),
                            slots.data(),
                            counts.data(),
                            heuristics.data(),
                            static_cast<int>(heuristics.size()),
                            outputs.data()};
  const IsaScope scope(isa);
  const auto& table = kernels<EstimatorKernels>();
  if constexpr (std::is_same_v<T, float>) {
    table.fold_f32(call);
  } else {
    table.fold_f64(call);
  }
  return {out.data(), out.data() + heuristics.size() * stride};
}

template <class T>
Way<T> by_fold(Isa isa) {
  return {"fold " + to_string(isa), [isa](const Heuristic& heuristic, const Table<T>& densities) {
            const std::size_t n = densities.size(), stride = densities[0].size();
            std::vector<int> slots;
            for (std::size_t q = 0; q < n; ++q) slots.push_back(static_cast<int>(q));
            Table<T> weights;
            for (std::size_t i = 0; i < n; ++i) {  // a value of 1 in one slot alone: its weight comes out
              Table<T> values(n, std::vector<T>(stride, T(0)));
              values[i].assign(stride, T(1));
              weights.push_back(folded<T>(isa, {heuristic}, densities, slots, values, std::vector<T>(n, T(1))));
            }
            return weights;
          }};
}

template <class T>
std::vector<Way<T>> every_way() {
  std::vector<Way<T>> ways = {by_template<T>("scalar"), by_template<NativePacket<T>>("packet")};
  for (const Isa isa : supported_isas()) ways.push_back(by_fold<T>(isa));
  return ways;
}

/// Densities log-uniform over 1e-30 … 1e30, one in five of them 0.
template <class T>
Table<T> random_densities(std::size_t techniques, std::size_t points, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  Table<T> densities(techniques, std::vector<T>(points));
  for (std::size_t p = 0; p < points; ++p) {
    for (auto& row : densities) {
      const double exponent = 60 * uniform() - 30;
      row[p] = uniform() < 0.2 ? T(0) : static_cast<T>(std::pow(10, exponent));
    }
  }
  return densities;
}

/// The weight by the definition, in logarithms: no range to leave.
template <class T>
double exact_weight(const Heuristic& heuristic, const Table<T>& densities, std::size_t i, std::size_t p) {
  const auto n = static_cast<long double>(densities.size());
  if (heuristic.kind == HeuristicKind::kAverage) return static_cast<double>(1 / n);
  const long double beta = heuristic.kind == HeuristicKind::kBalance ? 1 : heuristic.parameter;
  bool none = true;
  for (const auto& row : densities) none = none && row[p] == T(0);
  if (none) return static_cast<double>(1 / n);
  if (densities[i][p] == T(0)) return 0;
  // Half the digits of T decide whether a threshold is reached.
  long double largest = 0;
  for (const auto& row : densities) largest = std::max(largest, static_cast<long double>(row[p]));
  const long double near = (1 - (std::is_same_v<T, float> ? 0x1p-11L : 0x1p-26L)) * largest;
  if (heuristic.kind == HeuristicKind::kMaximum) {
    std::size_t first = 0;
    while (densities[first][p] < near) ++first;
    return i == first ? 1 : 0;
  }
  if (heuristic.kind == HeuristicKind::kCutoff) {
    const long double least = heuristic.parameter * near;
    long double kept = 0;
    for (const auto& row : densities) kept += row[p] >= least ? static_cast<long double>(row[p]) : 0;
    return densities[i][p] >= least ? static_cast<double>(densities[i][p] / kept) : 0;
  }
  long double sum = 0;
  const long double own = std::log(static_cast<long double>(densities[i][p]));
  for (const auto& row : densities) {
    if (row[p] != T(0)) sum += std::exp(beta * (std::log(static_cast<long double>(row[p])) - own));
  }
  return static_cast<double>(1 / sum);
}

}  // namespace halfslope
