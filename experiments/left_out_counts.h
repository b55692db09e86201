// Which of a range's sample counts some cells cannot have, told once for all that share them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace halfslope {

class LeftOutCounts {
 public:
  /// `estimator` on `sampler` takes none of `counts` (not empty), for a reason that ends with the nearest legal N.
  void add(const std::string& sampler, const std::string& estimator, const std::vector<std::uint64_t>& counts, bool all,
           const std::string& reason);
  /// A line for each set of counts: whose they are and why, by the example of the largest.
  std::vector<std::string> lines() const;
  /// The same, but one line for a sampler with many.
  std::vector<std::string> summary() const;

 private:
  struct Group {
    std::string sampler, reason;
    std::vector<std::uint64_t> counts;
    bool all;
    std::vector<std::string> estimators;
    std::string line() const;
  };
  std::vector<Group> groups_;
};

}  // namespace halfslope
