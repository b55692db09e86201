// What the checks found, for files and for people.
#include <algorithm>
#include <cmath>

#include "core/csv.h"
#include "experiments/joined.h"
#include "experiments/text_table.h"
#include "experiments/theory.h"

namespace halfslope {
namespace {

/// The rows of one check on one scene.
struct Group {
  std::string check, scene;
  std::size_t holds = 0, violated = 0;
  std::vector<std::string> not_judged;
  std::optional<double> least, most;  ///< measured / expected

  void add(const TheoryRow& row) {
    if (row.verdict == "violated") {
      ++violated;
    } else if (row.verdict == "holds") {
      ++holds;
    } else {
      not_judged.push_back(row.verdict);
    }
    if (!row.lo || !row.expected || *row.expected == 0) return;
    const double ratio = *row.measured / *row.expected;
    least = std::min(least.value_or(ratio), ratio);
    most = std::max(most.value_or(ratio), ratio);
  }
};

std::vector<Group> grouped(const TheoryReport& report) {
  std::vector<Group> groups;
  for (const TheoryCheckInfo& check : theory_checks()) {
    const std::size_t first = groups.size();
    for (const TheoryRow& row : report.rows) {
      if (row.check != check.name) continue;
      auto group = std::find_if(groups.begin() + static_cast<std::ptrdiff_t>(first), groups.end(),
                                [&](const Group& g) { return g.scene == row.cell.scene; });
      if (group == groups.end()) group = groups.insert(group, {row.check, row.cell.scene, 0, 0, {}, {}, {}});
      group->add(row);
    }
  }
  return groups;
}

/// What an experiment must have for a check to compare anything.
std::string needs_of(const std::string& check) {
  if (check == "exact-variance")
    return "a scene whose densities are known, such as mis-toy, and an estimator other than optimal-progressive";
  if (check == "average-bound") return "average beside each of its techniques alone, at the same N";
  return fmt::format("{} beside another heuristic of the same techniques and counts",
                     check == "balance-bound" ? "balance" : check);
}

// "3 (heavy-tailed, no-spread)"
std::string reasons(std::vector<std::string> not_judged) {
  const std::size_t count = not_judged.size();
  if (count == 0) return "0";
  std::ranges::sort(not_judged);
  const auto repeats = std::ranges::unique(not_judged);
  not_judged.erase(repeats.begin(), repeats.end());
  return fmt::format("{} ({})", count, joined(not_judged));
}

}  // namespace

std::vector<std::string> left_out_of_checks(const Plan& plan) {
  std::vector<std::string> lines, samplers;
  for (const Cell& cell : plan.cells) {
    if (cell.sampler != "independent" && std::ranges::find(samplers, cell.sampler) == samplers.end())
      samplers.push_back(cell.sampler);
  }
  if (!samplers.empty())
    lines.push_back(fmt::format("checks: left out {}: the theorems are about independent samples", joined(samplers)));
  for (const PlannedScene& scene : plan.scenes) {
    if (scene.source->techniques().size() < 2)
      lines.push_back(fmt::format("checks: left out {}: it has one technique, so nothing is combined", scene.name));
  }
  return lines;
}

std::string theory_csv(const TheoryReport& report) {
  CsvWriter csv({"scene", "check", "estimator", "sampler", "precision", "samples", "measured", "measured_lo",
                 "measured_hi", "bound_or_predicted", "verdict"});
  for (const TheoryRow& row : report.rows) {
    csv.cell(row.cell.scene).cell(row.check).cell(row.cell.estimator).cell(row.cell.sampler).cell(row.cell.precision);
    csv.cell(row.cell.samples).cell(row.measured).cell(row.lo).cell(row.hi).cell(row.expected);
    csv.cell(row.verdict).end_row();
  }
  return csv.text();
}

std::string theory_summary(const TheoryReport& report, std::span<const std::string> checks) {
  std::vector<std::vector<std::string>> rows = {
      {"check", "scene", "holds", "violated", "measured / bound or predicted", "not judged"}};
  for (const Group& g : grouped(report)) {
    rows.push_back({g.check, g.scene, std::to_string(g.holds), std::to_string(g.violated),
                    g.least ? fmt::format("{:.4g} to {:.4g}", *g.least, *g.most) : "-", reasons(g.not_judged)});
  }
  const bool judged = std::ranges::any_of(
      report.rows, [](const TheoryRow& row) { return row.verdict == "holds" || row.verdict == "violated"; });
  std::string text = fmt::format("theory: nothing could be {}\n", report.rows.empty() ? "checked" : "judged");
  if (judged) {
    text = fmt::format(
        "theory: {} of {} comparisons violated; their intervals hold together with probability 99 % (Bonferroni)\n",
        report.violated(), report.rows.size());
  }
  if (rows.size() > 1) text += align(rows, 2);
  for (const TheoryRow& row : report.rows) {
    if (row.verdict != "violated") continue;
    const std::string hi = row.hi ? fmt::format("{:.4g}]", *row.hi) : "inf)";
    text += fmt::format("  violated: {}, {}: measured {:.4g} [{:.4g}, {}, bound or predicted {:.4g}\n", row.check,
                        to_string(row.cell), *row.measured, *row.lo, hi, *row.expected);
  }
  for (const std::string& check : checks) {
    if (std::ranges::find(report.rows, check, &TheoryRow::check) == report.rows.end())
      text += fmt::format("  {} found nothing to check: it needs {}, on independent samples\n", check, needs_of(check));
  }
  return text;
}

}  // namespace halfslope
