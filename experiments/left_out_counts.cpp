#include "experiments/left_out_counts.h"

#include <algorithm>

#include "experiments/joined.h"

namespace halfslope {
namespace {

constexpr std::size_t kMany = 2;  // lines about one sampler that a person still reads

}  // namespace

void LeftOutCounts::add(const std::string& sampler, const std::string& estimator,
                        const std::vector<std::uint64_t>& counts, bool all, const std::string& reason) {
  auto group = std::find_if(groups_.begin(), groups_.end(),
                            [&](const Group& g) { return g.sampler == sampler && g.counts == counts && g.all == all; });
  if (group == groups_.end()) group = groups_.insert(groups_.end(), {sampler, reason, counts, all, {}});
  if (std::find(group->estimators.begin(), group->estimators.end(), estimator) == group->estimators.end())
    group->estimators.push_back(estimator);
}

std::string LeftOutCounts::Group::line() const {
  std::vector<std::string> numbers;
  for (const std::uint64_t n : counts) numbers.push_back(std::to_string(n));
  return fmt::format("{}: N = {} left out for {}{}: {}", sampler, joined(numbers), joined(estimators),
                     all ? ", which is all of the range" : "", reason);
}

std::vector<std::string> LeftOutCounts::lines() const {
  std::vector<std::string> lines;
  for (const Group& group : groups_) lines.push_back(group.line());
  return lines;
}

std::vector<std::string> LeftOutCounts::summary() const {
  std::vector<std::string> lines, told;
  for (const Group& group : groups_) {
    const auto same = [&](const Group& g) { return g.sampler == group.sampler; };
    const auto count = static_cast<std::size_t>(std::count_if(groups_.begin(), groups_.end(), same));
    if (count <= kMany) {
      lines.push_back(group.line());
    } else if (std::find(told.begin(), told.end(), group.sampler) == told.end()) {
      told.push_back(group.sampler);
      lines.push_back(
          fmt::format("{}: some N of the range left out, others for each estimator (--dry-run tells them); "
                      "for instance: {}",
                      group.sampler, group.reason));
    }
  }
  return lines;
}

}  // namespace halfslope
