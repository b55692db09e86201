#include "analysis/measures.h"

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace halfslope {
namespace {

constexpr std::size_t kAnyDims = std::numeric_limits<std::size_t>::max();

/// A measure without parameters that is one number, exact.
template <double (*kMeasure)(const PointSet&)>
MeasureInfo exact(std::string name, std::string description, std::string reference, std::size_t max_dims) {
  MeasureInfo info = {std::move(name), std::move(description), std::move(reference), max_dims, {}, false, {}};
  info.make = [name = info.name](const std::string&, const Parameters&) {
    return Measure{name, [](std::size_t, std::size_t) { return std::string(); },
                   [name](std::size_t, std::size_t) { return std::vector{name}; },
                   [](const PointSet& points) {
                     const double value = kMeasure(points);
                     return std::vector<MeasuredValue>{{value, value, value, "exact"}};
                   }};
  };
  return info;
}

}  // namespace

// The menu. To add a measure: a function of a PointSet in a file of its own, and a row here.
std::span<const MeasureInfo> measure_catalogue() {
  static const std::vector<MeasureInfo> catalogue = {
      exact<star_discrepancy>("star", "largest |share of the points - volume| over boxes anchored at the origin",
                              "H. Niederreiter, \"Random Number Generation and Quasi-Monte Carlo Methods\", 1992, "
                              "definition 2.1",
                              2),
      exact<l2_star_discrepancy>(
          "l2-star", "root of the mean of (share of the points - volume)^2 over boxes anchored at the origin",
          "T. T. Warnock, \"Computational investigations of low discrepancy point sets\", 1972", kAnyDims),
  };
  return catalogue;
}

std::vector<std::string> measure_names() {
  std::vector<std::string> names;
  for (const MeasureInfo& info : measure_catalogue()) names.push_back(info.name);
  return names;
}

Measure make_measure(const std::string& name) {
  const SplitName split = split_name(name);
  for (const MeasureInfo& info : measure_catalogue()) {
    if (info.name != split.head) continue;
    const std::string subject = "measure '" + name + "'";
    Measure measure = info.make(subject, parse_parameters(subject, split.parameters, info.parameters));
    measure.name = name;
    const auto refusal = measure.refusal;
    measure.refusal = [refusal, most = info.max_dims](std::size_t count, std::size_t dims) {
      return dims > most ? fmt::format("it takes at most {} dimensions", most) : refusal(count, dims);
    };
    return measure;
  }
  fail(ExitCode::kBadInput, "there is no measure '{}'{}", split.head, did_you_mean(split.head, measure_names()));
}

std::size_t measure_rank(std::string_view name) {
  const std::vector<std::string> names = measure_names();
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), split_name(name).head) - names.begin());
}

}  // namespace halfslope
