// selfcheck: what halfslope promises of its own numbers, measured again.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/coverage.h"
#include "core/error.h"
#include "experiments/commands.h"
#include "experiments/interrupt.h"
#include "experiments/joined.h"
#include "experiments/message.h"
#include "experiments/progress.h"
#include "experiments/text_table.h"

namespace halfslope {
namespace {

std::vector<CoverageStudyInfo> chosen_studies(const std::vector<std::string>& names) {
  const auto all = coverage_studies();
  if (names.empty()) return {all.begin(), all.end()};
  std::vector<std::string> known;
  for (const CoverageStudyInfo& study : all) known.emplace_back(study.name);
  std::vector<CoverageStudyInfo> chosen;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(all, name, &CoverageStudyInfo::name);
    if (found == all.end()) {
      fail(ExitCode::kUsage, "--study: there is no study '{}'{}; allowed: {}", name, did_you_mean(name, known),
           joined(known));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

/// "93.5 % to 96.5 %", "at least 80 %", "at most 2 %"; empty where nothing is promised.
std::string range(double least, double most) {
  if (least > 0 && most < 1) return percent(least) + " to " + percent(most);
  if (least > 0) return "at least " + percent(least);
  return most < 1 ? "at most " + percent(most) : "";
}

std::string table(const std::vector<CoverageRow>& rows) {
  std::vector<std::vector<std::string>> lines = {
      {"errors", "of", "method", "R", "runs", "coverage", "promised", "width", "marked", "promised", ""}};
  for (const CoverageRow& row : rows) {
    lines.push_back({row.law, row.number, row.method, fmt::to_string(row.replicates), fmt::to_string(row.runs),
                     percent(row.coverage()), range(row.coverage_least, row.coverage_most),
                     row.width > 0 ? fmt::format("{:.2f}", row.width) : "", percent(row.marked),
                     range(row.marked_least, row.marked_most), keeps_promise(row) ? "" : "BROKEN"});
  }
  return align(lines, 3);
}

nlohmann::ordered_json json_of(const CoverageRow& row) {
  return {{"law", row.law},
          {"number", row.number},
          {"method", row.method},
          {"replicates", row.replicates},
          {"runs", row.runs},
          {"coverage", row.coverage()},
          {"coverage_least", row.coverage_least},
          {"coverage_most", row.coverage_most},
          {"width", row.width},
          {"marked", row.marked},
          {"marked_least", row.marked_least},
          {"marked_most", row.marked_most},
          {"promise_kept", keeps_promise(row)}};
}

}  // namespace

int selfcheck_command(const SelfcheckArguments& a) {
  if (a.what != "coverage") {
    fail(ExitCode::kUsage, "there is no selfcheck of '{}'{}; allowed: coverage", a.what,
         did_you_mean(a.what, std::vector<std::string>{"coverage"}));
  }
  const InterruptGuard guard;
  std::vector<CoverageRow> rows;
  for (const CoverageStudyInfo& study : chosen_studies(a.studies)) {
    CoverageRequest request = {a.runs.value_or(study.runs), a.seed, a.threads, nullptr};
    Progress progress(fmt::format("coverage, {}", study.name), static_cast<double>(request.runs), a.quiet, "runs");
    request.progress = [&](double share) {
      progress.advance(share * static_cast<double>(request.runs));
      return !interrupted();
    };
    const auto measured = study.study(request);
    if (interrupted()) fail(ExitCode::kInterrupted, "interrupted; no table is made of a part of the runs");
    progress.finish();
    rows.insert(rows.end(), measured.begin(), measured.end());
  }
  if (a.json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const CoverageRow& row : rows) json.push_back(json_of(row));
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("{}", table(rows));
  }
  const auto broken = std::ranges::count_if(rows, [](const CoverageRow& row) { return !keeps_promise(row); });
  if (broken == 0) return static_cast<int>(ExitCode::kDone);
  message("halfslope: {} of {} rows are outside what is promised\n", broken, rows.size());
  return static_cast<int>(ExitCode::kCheckFailed);
}

}  // namespace halfslope
