// The files of a run folder, as text; docs/columns.md says what each column means.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/csv.h"
#include "experiments/results.h"

namespace halfslope {

std::string convergence_csv(const Results& results);
/// replicates.csv, cell by cell.
class ReplicatesTable {
 public:
  ReplicatesTable();
  /// `numbers` are what the replicates are called; empty: from 0 on.
  void add(const CellName& cell, const std::vector<ReplicateErrors>& replicates,
           std::span<const std::uint64_t> numbers = {});
  /// The text since the last call, the header first.
  std::string take_text() { return csv_.take_text(); }

 private:
  CsvWriter csv_;
};
std::string rates_csv(const Results& results);
std::string local_rates_csv(const Results& results);
/// Empty where there is nothing to compare.
std::string comparisons_csv(const Results& results);
/// Empty where no scene has parts.
std::string regions_csv(const Results& results);

/// tails.csv: how far a cell's intervals can be trusted, and why.
std::string tails_csv(const Results& results);

/// Before an interval that is not certified.
inline constexpr const char* kNotCertified = "~";
/// After the interval of a slope through errors that follow no line.
inline constexpr const char* kNotStraight = "*";
/// "[-0.51, -0.49]" with these marks; empty where there is none.
std::string rate_interval_text(const RateFit& fit);
/// What the marks in a text that has them mean, a line each.
std::string explained_marks(const std::string& text);

/// The rates of at least three scenes as a table: a row a sampler (and estimator, where there are several), a column a
/// scene. Empty where there are fewer, or one row.
std::string rates_side_by_side(const Results& results);

/// Who wins and who cannot be told apart, in the family's scene and at its N: a line for the samplers of each estimator
/// and for the estimators of each sampler. Empty where there is nothing to compare.
std::string comparisons_text(const Results& results, const ComparisonFamily& family);
/// Sentences on what the fits found: rates that differ from theory's, and errors that stop falling. Of certified
/// intervals alone, widened for as many lines as have one and a theory, so that chance makes a sentence in one run of
/// twenty. Empty where there is nothing to say.
std::string rate_remarks(const Results& results);

/// What a person wants to see first: the largest N side by side, rates, and where an image has parts, which estimator
/// wins where.
std::string summary(const Results& results);

}  // namespace halfslope
