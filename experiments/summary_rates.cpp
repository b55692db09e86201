// The rates of many scenes side by side.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "analysis/status.h"
#include "experiments/tables.h"
#include "experiments/text_table.h"

namespace halfslope {
namespace {

constexpr std::size_t kFewestScenes = 3;

std::string cell_text(const RateResult& rate) {
  if (!rate.fit.rate) return rate.fit.status;
  const std::string interval = rate_interval_text(rate.fit);
  return fmt::format("{:.2f}{}{}", *rate.fit.rate, interval.empty() ? "" : " ", interval);
}

void note(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

}  // namespace

std::string rate_interval_text(const RateFit& fit) {
  if (!fit.interval) return "";
  return fmt::format("{}[{:.2f}, {:.2f}]{}", is_certified(fit) ? "" : kNotCertified, fit.interval->lo, fit.interval->hi,
                     has_mark(fit.status, "pre-asymptotic") ? kNotStraight : "");
}

std::string explained_marks(const std::string& text) {
  std::string lines;
  if (text.find(std::string(kNotCertified) + "[") != std::string::npos) {
    lines += fmt::format(
        "  {} not certified: its coverage may be less than 95 %; status says why, of a rate that in rates.csv\n",
        kNotCertified);
  }
  if (text.find("]" + std::string(kNotStraight)) != std::string::npos) {
    lines += fmt::format(
        "  {} pre-asymptotic: the errors follow no line over all N; rates.csv has the rate where they do, if they do\n",
        kNotStraight);
  }
  return lines;
}

std::string rates_side_by_side(const Results& results) {
  std::vector<std::string> scenes, precisions;
  std::map<std::string, std::vector<std::string>> estimators;  // of each scene
  for (const CellResult& cell : results.cells) {
    note(scenes, cell.name.scene);
    note(precisions, cell.name.precision);
    note(estimators[cell.name.scene], cell.name.estimator);
  }
  std::vector<std::string> rows, columns;
  std::map<std::pair<std::string, std::string>, std::string> texts;
  for (const RateResult& rate : results.rates) {
    const CellName& name = results.cells[rate.first_cell].name;
    const std::string row = estimators[name.scene].size() == 1 ? name.sampler : name.sampler + " " + name.estimator;
    const std::string column = precisions.size() == 1 ? name.scene : name.scene + ", " + name.precision;
    note(rows, row);
    note(columns, column);
    texts.emplace(std::pair(row, column), cell_text(rate));  // the first is that over every N
  }
  if (scenes.size() < kFewestScenes || rows.size() < 2) return "";
  std::vector<std::vector<std::string>> table = {{"sampler"}};
  table[0].insert(table[0].end(), columns.begin(), columns.end());
  for (const std::string& row : rows) {
    std::vector<std::string> cells = {row};
    for (const std::string& column : columns) {
      const auto found = texts.find({row, column});
      cells.push_back(found == texts.end() ? "-" : found->second);
    }
    table.push_back(std::move(cells));
  }
  const std::string text = align(table, 1);
  return text + explained_marks(text);
}

}  // namespace halfslope
