#include <fmt/format.h>

#include <algorithm>

#include "experiments/measures.h"
#include "experiments/text_table.h"

namespace halfslope {
namespace {

// A curve is for a figure; of it the table has the name alone.
constexpr std::size_t kMostColumns = 6;

}  // namespace

std::vector<MeasuredMean> measured_means(const MeasuresPlan& plan, const Measurements& measured) {
  std::vector<MeasuredMean> means;
  std::size_t first = 0;  // of the N's rows
  for (const MeasuredPoints& p : plan.points) {
    const auto replicates = static_cast<std::size_t>(p.replicates);
    for (const MeasuredCount& n : p.counts) {
      for (std::size_t k = 0; k < n.rows.size(); ++k) {
        Moments value, lower, upper;
        for (std::size_t r = 0; r < replicates; ++r) {
          const MeasuredValue& one = measured[first + r * n.rows.size() + k];
          value.add(one.value);
          lower.add(one.lower);
          upper.add(one.upper);
        }
        std::string method(measured[first + k].method);
        for (std::size_t r = 1; r < replicates; ++r) {
          const std::string_view other = measured[first + r * n.rows.size() + k].method;
          if (method.find(other) == std::string::npos) method += fmt::format(" or {}", other);
        }
        const auto below = t_interval(lower), above = t_interval(upper);
        means.push_back({&p, n.count, n.rows[k], value.mean, below ? below->lo : lower.mean,
                         above ? above->hi : upper.mean,
                         replicates > 1 ? "mean, 95 % t interval; each " + method : method});
      }
      first += n.rows.size() * replicates;
    }
  }
  return means;
}

std::string measures_summary(const MeasuresPlan& plan, const Measurements& measured) {
  if (measured.empty()) return "";
  std::vector<std::string> names;
  for (const Measure& measure : plan.measures) {
    for (const MeasuredPoints& p : plan.points) {
      if (p.counts.empty()) continue;
      const auto rows = measure.rows(p.counts.back().count, static_cast<std::size_t>(p.layout.dims()));
      if (rows.size() == 1 && names.size() < kMostColumns) names.push_back(rows.front());
      break;
    }
  }
  std::vector<std::vector<std::string>> rows = {{"sampler", "N", "replicates"}};
  for (const std::string& name : names) {
    rows[0].push_back(name);
    rows[0].push_back("95 %");
  }
  const std::vector<MeasuredMean> means = measured_means(plan, measured);
  int dims = 0;
  for (const MeasuredPoints& p : plan.points) {
    if (p.counts.empty()) continue;
    dims = p.layout.dims();
    const std::uint64_t largest = p.counts.back().count;
    std::vector<std::string> row = {p.sampler, std::to_string(largest), std::to_string(p.replicates)};
    for (const std::string& name : names) {
      const auto mean = std::find_if(means.begin(), means.end(), [&](const MeasuredMean& m) {
        return m.points == &p && m.count == largest && m.name == name;
      });
      const bool found = mean != means.end();
      row.push_back(found ? fmt::format("{:.3g}", mean->value) : "");
      row.push_back(found && mean->upper > mean->lower ? fmt::format("[{:.3g}, {:.3g}]", mean->lower, mean->upper)
                                                       : "");
    }
    rows.push_back(std::move(row));
  }
  return fmt::format("discrepancy of the samplers' points in {} dimensions, mean over replicates\n\n{}", dims,
                     align(rows, 1));
}

}  // namespace halfslope
