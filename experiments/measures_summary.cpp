#include <fmt/format.h>

#include <algorithm>

#include "analysis/intervals.h"
#include "experiments/measures.h"
#include "experiments/text_table.h"

namespace halfslope {
namespace {

// A curve is for a figure; of it the table has the name alone.
constexpr std::size_t kMostColumns = 6;

}  // namespace

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
  int dims = 0;
  std::size_t end = 0;  // of the sampler's rows, the last of which are those of its largest N
  for (const MeasuredPoints& p : plan.points) {
    if (p.counts.empty()) continue;
    dims = p.layout.dims();
    end += p.rows();
    const auto replicates = static_cast<std::size_t>(p.replicates);
    const MeasuredCount& largest = p.counts.back();
    std::vector<std::string> row = {p.sampler, std::to_string(largest.count), std::to_string(replicates)};
    for (const std::string& name : names) {
      const auto found = std::find(largest.rows.begin(), largest.rows.end(), name);
      if (found == largest.rows.end()) {
        row.insert(row.end(), {"", ""});
        continue;
      }
      const auto m = static_cast<std::size_t>(found - largest.rows.begin());
      Moments moments;
      for (std::size_t r = 0; r < replicates; ++r)
        moments.add(measured[end - (replicates - r) * largest.rows.size() + m].value);
      const auto interval = replicates > 1 ? t_interval(moments) : std::nullopt;
      row.push_back(fmt::format("{:.3g}", moments.mean));
      row.push_back(interval ? fmt::format("[{:.3g}, {:.3g}]", interval->lo, interval->hi) : "");
    }
    rows.push_back(std::move(row));
  }
  return fmt::format("discrepancy of the samplers' points in {} dimensions, mean over replicates\n\n{}", dims,
                     align(rows, 1));
}

}  // namespace halfslope
