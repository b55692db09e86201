// The measures of a point set there are, by name.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/discrepancy.h"
#include "core/generator_matrices.h"
#include "core/parameters.h"

namespace halfslope {

/// What a measure says of points: its value, and what it lies between where it cannot be known exactly; all three are
/// the same where `method` is "exact".
struct MeasuredValue {
  double value = 0, lower = 0, upper = 0;
  std::string_view method;
};

/// A measure whose parameters are chosen.
struct Measure {
  std::string name;  ///< as it was asked for: "star", "pcf:bins=200"
  /// Why it cannot measure `count` points of `dims` dimensions (too many for its time or memory, which it states, or
  /// not its kind); empty where it can.
  std::function<std::string(std::size_t count, std::size_t dims)> refusal;
  /// What the values of so many points are called: its name, or for a curve one name a place, such as "pcf:r=0.125".
  std::function<std::vector<std::string>(std::size_t count, std::size_t dims)> rows;
  /// The values themselves, in the order of `rows`.
  std::function<std::vector<MeasuredValue>(const PointSet& points)> values;
  /// Whether the generator matrices of a digital net give the values of its first `count` points, even where `refusal`
  /// speaks of them; null for a measure that has no use for matrices.
  std::function<bool(const GeneratorMatrices& matrices, std::size_t count)> takes_net = nullptr;
  std::function<std::vector<MeasuredValue>(const GeneratorMatrices& matrices, std::size_t count)> net_values = nullptr;
};

/// What `list measures` says of one.
struct MeasureInfo {
  std::string name, description, reference;
  std::size_t max_dims;                    ///< of the points it takes
  std::vector<Parameter> parameters = {};  ///< all with a fallback
  bool curve = false;                      ///< several values of one point set
  /// `subject` begins messages about parameters that are out of range.
  std::function<Measure(const std::string& subject, const Parameters& parameters)> make;
  std::size_t min_dims = 1;
};

/// Every measure, in the order of the tables.
std::span<const MeasureInfo> measure_catalogue();

/// Their names, in that order.
std::vector<std::string> measure_names();

/// The measure of that name, parameters included. Error(kBadInput) naming the nearest where there is none.
Measure make_measure(const std::string& name);

/// The place of a name in the catalogue, for order; the parameters do not matter.
std::size_t measure_rank(std::string_view name);

}  // namespace halfslope
