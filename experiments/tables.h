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

/// The rates of at least three scenes as a table: a row a sampler (and estimator, where there are several), a column a
/// scene. Empty where there are fewer, or one row.
std::string rates_side_by_side(const Results& results);

/// Who wins and who cannot be told apart, in the family's scene and at its N: a line for the samplers of each estimator
/// and for the estimators of each sampler. Empty where there is nothing to compare.
std::string comparisons_text(const Results& results, const ComparisonFamily& family);
/// Sentences on what the fits found: rates that differ from theory's beyond their interval, and errors that stop
/// falling. Empty where there is nothing to say.
std::string rate_remarks(const Results& results);

/// What a person wants to see first: the largest N side by side, rates, and where an image has parts, which estimator
/// wins where.
std::string summary(const Results& results);

}  // namespace halfslope
