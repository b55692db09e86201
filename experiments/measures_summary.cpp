#include <fmt/format.h>

#include "analysis/intervals.h"
#include "experiments/measures.h"
#include "experiments/measures_layout.h"
#include "experiments/text_table.h"

namespace halfslope {

std::string measures_summary(const MeasuresPlan& plan, const Measurements& measured) {
  if (measured.empty()) return "";
  std::vector<std::vector<std::string>> rows = {{"sampler", "N", "replicates"}};
  for (const MeasureInfo* info : plan.measures) {
    rows[0].push_back(info->name);
    rows[0].push_back("95 %");
  }
  std::size_t end = 0;  // of the sampler's rows, the last of which are those of its largest N
  for (const MeasuredPoints& p : plan.points) {
    if (p.counts.empty()) continue;
    const auto replicates = static_cast<std::size_t>(p.replicates);
    end += p.counts.size() * replicates * plan.measures.size();
    std::vector<std::string> row = {p.sampler, std::to_string(p.counts.back()), std::to_string(replicates)};
    for (std::size_t m = 0; m < plan.measures.size(); ++m) {
      Moments moments;
      for (std::size_t r = 0; r < replicates; ++r)
        moments.add(measured[end - (replicates - r) * plan.measures.size() + m].value);
      const auto interval = replicates > 1 ? t_interval(moments) : std::nullopt;
      row.push_back(fmt::format("{:.3g}", moments.mean));
      row.push_back(interval ? fmt::format("[{:.3g}, {:.3g}]", interval->lo, interval->hi) : "");
    }
    rows.push_back(std::move(row));
  }
  return fmt::format("discrepancy of the samplers' points in {} dimensions, mean over replicates\n\n{}", kPair.dims(),
                     align(rows, 1));
}

}  // namespace halfslope
