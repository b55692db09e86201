// The rates of many scenes side by side.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "experiments/tables.h"
#include "experiments/text_table.h"

namespace halfslope {
namespace {

constexpr std::size_t kFewestScenes = 3;

std::string cell_text(const RateResult& rate) {
  if (!rate.fit.rate) return rate.fit.status;
  if (!rate.fit.interval) return fmt::format("{:.2f}", *rate.fit.rate);
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", *rate.fit.rate, rate.fit.interval->lo, rate.fit.interval->hi);
}

void note(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

}  // namespace

std::string rates_side_by_side(const Plan& plan, const Results& results) {
  const auto other = std::ranges::find_if(
      plan.cells, [&](const Cell& cell) { return cell.precision != plan.cells.front().precision; });
  const int precisions = other == plan.cells.end() ? 1 : 2;
  std::vector<std::string> rows, columns;
  std::map<std::pair<std::string, std::string>, std::string> texts;
  for (const RateResult& rate : results.rates) {
    const Cell& cell = plan.cells[rate.first_cell];
    const PlannedScene& scene = plan.scenes[cell.scene];
    const bool one_estimator = scene.estimators.size() == 1;
    const std::string row = one_estimator ? cell.sampler : cell.sampler + " " + scene.estimators[cell.estimator].name;
    const std::string column = precisions == 1 ? scene.name : scene.name + ", " + to_string(cell.precision);
    note(rows, row);
    note(columns, column);
    texts.emplace(std::pair(row, column), cell_text(rate));  // the first is that over every N
  }
  if (plan.scenes.size() < kFewestScenes || rows.size() < 2) return "";
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
  return align(table, 1);
}

}  // namespace halfslope
