// Who wins, and who cannot be told apart.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "experiments/joined.h"
#include "experiments/tables.h"

namespace halfslope {
namespace {

constexpr std::size_t kPageWidth = 118;

/// The cells that share an estimator or a sampler, and how they are called beside each other.
struct Line {
  std::string title;  ///< what they share
  std::vector<std::size_t> cells;
  std::vector<std::string> names;
};

std::vector<Line> lines_of(const Results& results, const ComparisonFamily& family) {
  std::vector<Line> lines;
  const auto gather = [&](std::string CellName::*shared, std::string CellName::*own) {
    std::vector<std::string> titles;
    for (const std::size_t c : family.cells) {
      const CellName& name = results.cells[c].name;
      if (std::ranges::find(titles, name.*shared) == titles.end()) titles.push_back(name.*shared);
    }
    for (const std::string& title : titles) {
      Line line{title, {}, {}};
      for (const std::size_t c : family.cells) {
        if (results.cells[c].name.*shared != title) continue;
        line.cells.push_back(c);
        line.names.push_back(results.cells[c].name.*own);
      }
      if (line.cells.size() > 1) lines.push_back(std::move(line));
    }
  };
  gather(&CellName::estimator, &CellName::sampler);
  gather(&CellName::sampler, &CellName::estimator);
  return lines;
}

/// The family's comparisons, asked for in either order.
class Lookup {
 public:
  explicit Lookup(const ComparisonFamily& family) {
    for (const ComparedCells& row : family.rows) {
      rows_.emplace(std::pair(row.a, row.b), &row.comparison);
      for (const std::size_t c : {row.a, row.b}) said_[c] = said_[c] || ranked(row.a, row.b);
    }
  }

  const Comparison* find(std::size_t a, std::size_t b) const {
    const auto found = rows_.find(std::minmax(a, b));
    return found == rows_.end() ? nullptr : found->second;
  }

  bool beats(std::size_t a, std::size_t b) const {
    const Comparison* comparison = find(a, b);
    return comparison && comparison->verdict == (a < b ? Verdict::kABetter : Verdict::kBBetter);
  }

  bool alike(std::size_t a, std::size_t b) const {
    const Comparison* comparison = find(a, b);
    return comparison && comparison->status.starts_with("equal");
  }

  /// Whether the two were held against each other, or err alike.
  bool ranked(std::size_t a, std::size_t b) const {
    const Comparison* comparison = find(a, b);
    return comparison && (comparison->verdict != Verdict::kNone || alike(a, b));
  }

  /// The cells, and whether any comparison says something of each.
  const std::map<std::size_t, bool>& said() const { return said_; }

 private:
  std::map<std::size_t, bool> said_;
  std::map<std::pair<std::size_t, std::size_t>, const Comparison*> rows_;
};

std::string with_status(const std::string& name, const CellResult& cell) {
  return fmt::format("{} ({})", name, cell.statistics.status);
}

std::string and_joined(const std::vector<std::string>& names) {
  if (names.size() < 2) return names.empty() ? "" : names[0];
  return fmt::format("{} and {}", joined(std::vector(names.begin(), names.end() - 1)), names.back());
}

/// A group of a line, as places in it. None of it beats another of it.
using Group = std::vector<std::size_t>;

std::vector<std::string> names_of(const Line& line, const Group& group) {
  std::vector<std::string> names;
  for (const std::size_t k : group) names.push_back(line.names[k]);
  return names;
}

bool beaten(const Line& line, std::size_t k, const Group& others, const Lookup& lookup) {
  return std::ranges::any_of(others, [&](std::size_t j) { return lookup.beats(line.cells[j], line.cells[k]); });
}

/// Those of `group` that none of it beats: no two of them can be told apart. The others keep their order.
Group take_unbeaten(const Line& line, Group& group, const Lookup& lookup) {
  Group front, rest;
  for (const std::size_t k : group) (beaten(line, k, group, lookup) ? rest : front).push_back(k);
  group = std::move(rest);
  return front;
}

/// Cuts a line wherever each on the one side beats each on the other; within a group the line's own order remains.
std::vector<Group> certain_order(const Line& line, const Group& group, const Results& results, const Lookup& lookup) {
  const auto mse = [&](std::size_t k) {
    const CellResult& cell = results.cells[line.cells[k]];
    return cell.mse - cell.statistics.reference_mse;
  };
  Group by_mse = group;
  std::ranges::stable_sort(by_mse, {}, mse);
  std::vector<Group> groups(1);
  for (std::size_t i = 0; i < by_mse.size(); ++i) {
    const bool cut = std::all_of(by_mse.begin(), by_mse.begin() + static_cast<std::ptrdiff_t>(i), [&](std::size_t a) {
      return std::all_of(by_mse.begin() + static_cast<std::ptrdiff_t>(i), by_mse.end(),
                         [&](std::size_t b) { return lookup.beats(line.cells[a], line.cells[b]); });
    });
    if (i > 0 && cut) groups.emplace_back();
    groups.back().push_back(by_mse[i]);
  }
  for (Group& cut : groups) std::ranges::sort(cut);
  return groups;
}

/// "about 900 to 1500": two digits are all that a prediction has.
std::string about(const Prediction& prediction) {
  const auto rounded = [](double x) {
    const double unit = std::pow(10, std::max(0.0, std::floor(std::log10(x)) - 1));
    return fmt::format("{:.0f}", std::ceil(x / unit) * unit);
  };
  const std::string lo = rounded(prediction.lo), hi = rounded(prediction.hi);
  return lo == hi ? lo : fmt::format("{} to {}", lo, hi);
}

/// What the members of a group say of each other; empty of one alone.
std::string tie_text(const Line& line, const Group& group, const Lookup& lookup) {
  const Comparison* hardest = nullptr;
  bool all_alike = group.size() > 1;
  for (std::size_t i = 0; i < group.size(); ++i) {
    for (std::size_t j = i + 1; j < group.size(); ++j) {
      const std::size_t a = line.cells[group[i]], b = line.cells[group[j]];
      all_alike = all_alike && lookup.alike(a, b);
      const Comparison* comparison = lookup.find(a, b);
      if (!comparison || !comparison->replicates_needed) continue;
      if (!hardest || comparison->replicates_needed->value > hardest->replicates_needed->value) hardest = comparison;
    }
  }
  const std::string names = and_joined(names_of(line, group));
  if (all_alike) return names + " err alike, replicate by replicate";
  if (!hardest) return "";
  return fmt::format("{} cannot be told apart at this budget; about {} replicates would tell a 10 % difference", names,
                     about(*hardest->replicates_needed));
}

/// "A beats B by 1.8× [1.7, 1.9]" of the two of neighbouring groups that are nearest to each other; empty where no
/// ratio has an interval.
std::string win_text(const Line& line, const Group& winners, const Group& losers, const Lookup& lookup) {
  std::string text;
  double nearest = 0;
  for (const std::size_t i : winners) {
    for (const std::size_t j : losers) {
      const std::size_t a = line.cells[i], b = line.cells[j];
      if (!lookup.beats(a, b)) continue;
      const Comparison& comparison = *lookup.find(a, b);
      const double ratio = std::exp(std::abs(*comparison.log_ratio));
      if (!comparison.interval || (!text.empty() && ratio >= nearest)) continue;
      nearest = ratio;
      const Interval& log = *comparison.interval;
      const double lo = a < b ? std::exp(-log.hi) : std::exp(log.lo), hi = a < b ? std::exp(-log.lo) : std::exp(log.hi);
      const bool doubtful = comparison.status != "ok";
      text = fmt::format("{} beats {} by {:.3g}× [{:.3g}, {:.3g}]{}", line.names[i], line.names[j], ratio, lo, hi,
                         doubtful ? fmt::format(" ({})", comparison.status) : "");
    }
  }
  return text;
}

/// Words in lines of a page, after an indent.
std::string wrapped(const std::string& words, const std::string& indent) {
  std::string text, line = indent;
  for (std::size_t at = 0; at < words.size();) {
    const std::size_t end = std::min(words.find(' ', at), words.size());
    if (line.size() > indent.size() && line.size() + 1 + (end - at) > kPageWidth) {
      text += line + "\n";
      line = indent;
    }
    line += (line.size() > indent.size() ? " " : "") + words.substr(at, end - at);
    at = end + 1;
  }
  return text + line + "\n";
}

std::string all_pairs_text(const Line& line, const Results& results, const Lookup& lookup) {
  Group ranked;
  std::vector<std::string> unranked;  // here, though not everywhere
  for (std::size_t k = 0; k < line.cells.size(); ++k) {
    const std::size_t cell = line.cells[k];
    if (std::ranges::any_of(line.cells, [&](std::size_t other) { return lookup.ranked(cell, other); })) {
      ranked.push_back(k);
    } else if (const auto said = lookup.said().find(cell); said != lookup.said().end() && said->second) {
      unranked.push_back(with_status(line.names[k], results.cells[cell]));
    }
  }
  if (ranked.empty()) return "";
  const std::string rest = unranked.empty() ? "" : wrapped("not compared: " + joined(unranked), "    ");
  const std::vector<Group> order = certain_order(line, ranked, results, lookup);
  const Group first = take_unbeaten(line, ranked, lookup), second = take_unbeaten(line, ranked, lookup);
  const std::string tie = tie_text(line, first, lookup), win = win_text(line, first, second, lookup);
  if (second.empty() && !tie.empty()) return wrapped(line.title + ": " + tie, "  ") + rest;
  std::string chain;
  for (const Group& group : order) chain += (chain.empty() ? "" : " < ") + joined(names_of(line, group));
  std::string text = wrapped(line.title + ": " + chain, "  ");
  if (!tie.empty()) text += wrapped("beaten by none: " + tie, "    ");
  if (!win.empty()) text += wrapped(win, "    ");
  return text + rest;
}

// Too many for all pairs: what is known is where each stands beside the first.
std::string with_first_text(const Line& line, const Lookup& lookup) {
  std::vector<std::string> better, alike, worse;
  for (std::size_t k = 1; k < line.cells.size(); ++k) {
    if (!lookup.ranked(line.cells[0], line.cells[k])) continue;
    if (lookup.beats(line.cells[k], line.cells[0])) {
      better.push_back(line.names[k]);
    } else {
      (lookup.beats(line.cells[0], line.cells[k]) ? worse : alike).push_back(line.names[k]);
    }
  }
  std::string text = wrapped(line.title + ":", "  ");
  const auto say = [&](const char* what, const std::vector<std::string>& names) {
    if (!names.empty()) text += wrapped(fmt::format("{} {}: {}", what, line.names[0], joined(names)), "    ");
  };
  say("better than", better);
  say("not told apart from", alike);
  say("worse than", worse);
  return text;
}

/// "halton (deterministic), bsdf (exact)": the cells of which no comparison says anything, with their status; by the
/// sampler or the estimator alone where that is so of all its cells.
std::string not_compared(const Results& results, const Lookup& lookup) {
  std::vector<std::string> names;
  const auto nothing_of = [&](std::string CellName::*part, const CellName& name) {
    return std::ranges::all_of(lookup.said(), [&](const auto& entry) {
      return results.cells[entry.first].name.*part != name.*part || !entry.second;
    });
  };
  for (const auto& [cell, says] : lookup.said()) {
    if (says) continue;
    const CellName& name = results.cells[cell].name;
    const std::string shortest = nothing_of(&CellName::sampler, name)     ? name.sampler
                                 : nothing_of(&CellName::estimator, name) ? name.estimator
                                                                          : name.estimator + " on " + name.sampler;
    const std::string text = with_status(shortest, results.cells[cell]);
    if (std::ranges::find(names, text) == names.end()) names.push_back(text);
  }
  return names.empty() ? "" : wrapped("not compared: " + joined(names), "  ");
}

}  // namespace

std::string comparisons_text(const Results& results, const ComparisonFamily& family) {
  const Lookup lookup(family);
  std::string text;
  for (const Line& line : lines_of(results, family)) {
    text += family.with_first_only ? with_first_text(line, lookup) : all_pairs_text(line, results, lookup);
  }
  if (text.empty()) return "";
  text += not_compared(results, lookup);
  const auto count =
      std::ranges::count_if(family.rows, [](const ComparedCells& row) { return row.comparison.p.has_value(); });
  return fmt::format(
             "Differences of MSE, with 5 % for any false alarm in {}. \"A < B\": each of A beats each of B.\n"
             "\"By 2×\": the mean of twice as many replicates would make up for it.\n\n",
             count == 1 ? "1 comparison" : fmt::format("{} comparisons", count)) +
         text;
}

}  // namespace halfslope
