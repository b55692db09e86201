// How often intervals hold the truth, measured on errors whose law is known.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
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
  /// What is promised of the two shares; by default nothing.
  double coverage_least = 0, coverage_most = 1, marked_least = 0, marked_most = 1;

  double coverage() const { return static_cast<double>(covered) / static_cast<double>(runs); }
  bool promises() const { return coverage_least > 0 || coverage_most < 1 || marked_least > 0 || marked_most < 1; }
};

/// Whether the row's shares lie within what is promised, to within the chance of so few runs: promises are for 20 000,
/// and with fewer each bound moves outwards by five times what a share's standard error, √(q(1 − q)/runs) at the bound
/// q, is larger than it is there. 4000 runs turn 93.5 % into 92.5 %.
bool keeps_promise(const CoverageRow& row);

/// What a study is asked for. Every run has random numbers of its own, so the table does not depend on the threads.
struct CoverageRequest {
  std::int64_t runs = 4000;  ///< of every row
  std::uint64_t seed = 1;
  int threads = 0;                                 ///< 0: all
  std::function<bool(double)> progress = nullptr;  ///< told the share done since the last call; false: stop
};

/// A study simulates some of the rows. `progress` may be called from any thread; the shares of one study add up to 1.
/// Stopped, it returns the rows that were finished. To add one: a function of this shape in a file coverage_*.cpp, and
/// a line in coverage_studies().
using CoverageStudy = std::vector<CoverageRow> (*)(const CoverageRequest& request);

/// A line of the menu.
struct CoverageStudyInfo {
  std::string_view name, description;
  CoverageStudy study;
  std::int64_t runs;  ///< of every row, where nothing else is asked for
};

/// Every study.
std::span<const CoverageStudyInfo> coverage_studies();

/// Calls body(run) for every run of [0, request.runs), on request.threads threads, and tells request.progress `share`
/// in small parts. False where that said stop; some runs are then missing.
bool for_each_run(const CoverageRequest& request, double share, const std::function<void(std::int64_t run)>& body);

}  // namespace halfslope
