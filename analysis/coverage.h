// How often intervals hold the truth, measured on errors whose law is known.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace halfslope {

/// One line of the table: an interval, a law of errors, and how often the one held the truth of the other.
struct CoverageRow {
  std::string number;           ///< what the interval is of: "rmse", "mean", "rate", "ratio"
  std::string method;           ///< "bootstrap-t", …
  std::string law;              ///< of the errors: "Gaussian", "256 pixels of lognormal(1.5) means of 64"
  std::int64_t replicates = 0;  ///< R of each run
  std::int64_t runs = 0, covered = 0;
  double width = 0;  ///< mean of log(hi/lo), or of hi − lo where the number is a rate or may be negative; 0: not known
  double marked = 0;  ///< share of the runs that were marked as not certified
  double coverage() const { return static_cast<double>(covered) / static_cast<double>(runs); }
};

/// What a study is asked for. Every run has random numbers of its own, so the table does not depend on the threads.
struct CoverageRequest {
  std::int64_t runs = 4000;  ///< of every row
  std::uint64_t seed = 1;
  int threads = 0;                                 ///< 0: all
  std::function<bool(double)> progress = nullptr;  ///< told the share done since the last call; false: stop
};

/// A study simulates some of the rows. To add one: a function of this shape in a file coverage_*.cpp, and a line in
/// coverage_studies().
using CoverageStudy = std::vector<CoverageRow> (*)(const CoverageRequest& request);

}  // namespace halfslope
