// The files of a run folder that tell of time, as text, and what a person sees of them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "experiments/timing_results.h"

namespace halfslope {

std::string timing_csv(const std::vector<TimingResult>& rows);
/// timing_parts.csv: points and evaluation apart, and how it was timed.
std::string timing_parts_csv(const std::vector<TimingResult>& rows);
std::string equal_time_csv(const std::vector<TimingResult>& rows);
std::string equal_error_csv(const std::vector<TimingResult>& rows);

/// timing.json: every repetition in the JSON of Google Benchmark (run_type `iteration`, an iteration being the estimate
/// of one integral; times in ns), with counters rmse, ns_per_sample and efficiency, so that its tools compare two runs.
std::string timing_json(const std::vector<TimingResult>& rows, const std::string& experiment);

/// The files that hold these texts.
inline constexpr std::array<const char*, 5> kTimingFiles = {"timing.csv", "timing_parts.csv", "equal_time.csv",
                                                            "equal_error.csv", "timing.json"};

/// Of each scene and precision, what the lines cost at the largest N, by efficiency, and what each reaches in equal
/// time and for equal error. Places in the ranking are ranges where intervals overlap. Empty where nothing was timed.
std::string timing_summary(const std::vector<TimingResult>& rows);

}  // namespace halfslope
