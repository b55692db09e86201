// What a person wants to see of time: who is efficient, and what equal time and equal error give.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/status.h"
#include "experiments/text_table.h"
#include "experiments/timing_tables.h"

namespace halfslope {
namespace {

/// "[0.9, 1.2]", behind a mark where it may cover less than the 95 % that its column promises.
std::string between(const PositiveEstimate& e, bool certified) {
  const auto end = [](const std::optional<double>& x) { return x ? fmt::format("{:.3g}", *x) : "-"; };
  return e.lo || e.hi ? fmt::format("{}[{}, {}]", certified ? "" : "~", end(e.lo), end(e.hi)) : "";
}

/// "3.4 us": of the three digits that times are good for.
std::string time_text(double seconds) {
  if (seconds < 1e-6) return fmt::format("{:.3g} ns", seconds * 1e9);
  if (seconds < 1e-3) return fmt::format("{:.3g} us", seconds * 1e6);
  return seconds < 1 ? fmt::format("{:.3g} ms", seconds * 1e3) : fmt::format("{:.3g} s", seconds);
}

PositiveEstimate microseconds(const PositiveEstimate& e) {
  const auto end = [](const std::optional<double>& x) { return x ? std::optional(*x * 1e6) : std::nullopt; };
  return {e.value * 1e6, end(e.lo), end(e.hi)};
}

/// The rows of one scene and precision at its largest N.
std::vector<std::vector<const TimingResult*>> largest_slices(const std::vector<TimingResult>& rows) {
  std::vector<std::vector<const TimingResult*>> slices;
  for (const TimingResult& row : rows) {
    auto slice = std::ranges::find_if(slices, [&](const auto& s) {
      return s.front()->name.scene == row.name.scene && s.front()->name.precision == row.name.precision;
    });
    if (slice == slices.end()) slice = slices.insert(slice, std::vector<const TimingResult*>());
    if (!slice->empty() && row.name.samples > slice->front()->name.samples) slice->clear();
    if (slice->empty() || row.name.samples == slice->front()->name.samples) slice->push_back(&row);
  }
  return slices;
}

std::string place_text(const std::optional<Places>& place) { return place ? place->text() : "-"; }

/// Whether two of the places are one: the reader is then told what that means.
bool any_shared(const std::vector<std::optional<Places>>& all) {
  return std::ranges::any_of(all, [](const auto& place) { return place && place->first < place->last; });
}

constexpr const char* kShared =
    "  A place such as 2-5 is a range: the intervals overlap, so the order among these cannot be told apart.\n";

/// What a reader of the table must know: why intervals are marked, and what places are.
std::string notes(const std::string& table, const std::vector<std::optional<Places>>& place) {
  std::string text;
  if (table.find("~[") != std::string::npos)
    text += "  ~ not certified: its coverage may be less than 95 %; status says why\n";
  if (table.find("few-repetitions") != std::string::npos) {
    text +=
        "  few-repetitions: an interval of so few timings is their range, which covers less than 95 %; 6 are enough\n";
  }
  return text + (any_shared(place) ? kShared : "");
}

std::string efficiency_table(std::vector<const TimingResult*> slice) {
  // No error at all is as efficient as can be.
  const auto value = [](const TimingResult* row) {
    return row->exact ? HUGE_VAL : row->efficiency ? row->efficiency->value : 0;
  };
  std::ranges::stable_sort(slice, std::greater<>(), value);
  std::vector<PositiveEstimate> estimates;
  for (const TimingResult* row : slice) estimates.push_back(row->efficiency.value_or(PositiveEstimate()));
  const auto place = places(estimates, true);
  std::vector<std::vector<std::string>> table = {
      {"sampler", "estimator", "efficiency", "95 %", "place", "ns/sample", "95 %", "points", "status"}};
  for (std::size_t k = 0; k < slice.size(); ++k) {
    const TimingResult& row = *slice[k];
    const bool known = row.efficiency.has_value();
    table.push_back({row.name.sampler, row.name.estimator, known ? fmt::format("{:.3g}", row.efficiency->value) : "-",
                     known ? between(*row.efficiency, row.certified && row.covered()) : "", place_text(place[k]),
                     fmt::format("{:.3g}", row.all.median),
                     between({row.all.median, row.all.interval.lo, row.all.interval.hi}, row.covered()),
                     fmt::format("{:.3g}", row.points.median), row.status});
  }
  const std::string text = align(table, 2);
  return text + notes(text, place);
}

/// The marks of both answers, each once; why there is none stands in its own place.
std::string status_of(const LineAnswer& error, const LineAnswer& time) {
  Status status;
  for (const char* mark : {"uncertified", "few-repetitions"})
    status.mark_if(has_mark(error.status(), mark) || has_mark(time.status(), mark), mark);
  const bool some = error.answer.reach == Reach::kInside || time.answer.reach == Reach::kInside;
  return some ? status.text() : error.status();
}

/// Two answers of each line: the error after a time, and the time to an error.
std::string equal_table(const EqualWork& errors, const EqualWork& times) {
  const auto value = [](const LineAnswer& line) {
    if (line.answer.reach == Reach::kExact) return 0.0;
    return line.answer.reach == Reach::kInside ? line.answer.value.value : HUGE_VAL;
  };
  std::vector<std::size_t> order(errors.lines.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return value(errors.lines[k]); });
  std::vector<PositiveEstimate> estimates;
  for (const std::size_t k : order) estimates.push_back(errors.lines[k].answer.value);
  const auto place = places(estimates, false);
  std::vector<std::vector<std::string>> table = {
      {"sampler", "estimator", "N", "rmse", "95 %", "place", "time in us", "95 %", "status"}};
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto& [line, error] = errors.lines[order[k]];
    const WorkAnswer& time = times.lines[order[k]].answer;
    const bool has_error = error.reach == Reach::kInside, has_time = time.reach == Reach::kInside;
    const auto interval = [](const WorkAnswer& of, const PositiveEstimate& e) {
      return of.reach == Reach::kInside ? between(e, of.certified && of.covered) : "";
    };
    const PositiveEstimate us = microseconds(time.value);
    table.push_back({line.sampler, line.estimator, has_error ? fmt::format("{:.0f}", error.samples) : "-",
                     has_error ? fmt::format("{:.3g}", error.value.value) : std::string(to_string(error.reach)),
                     interval(error, error.value), place_text(place[k]),
                     has_time ? fmt::format("{:.3g}", us.value) : std::string(to_string(time.reach)),
                     interval(time, us), status_of(errors.lines[order[k]], times.lines[order[k]])});
  }
  const std::string text = align(table, 2);
  return text + notes(text, place);
}

const EqualWork* find_first(const std::vector<EqualWork>& table, const CellName& name) {
  const auto found = std::ranges::find_if(table, [&](const EqualWork& work) {
    return work.lines.front().line.scene == name.scene && work.lines.front().line.precision == name.precision;
  });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace

std::string timing_summary(const std::vector<TimingResult>& rows) {
  std::string text;
  const std::vector<EqualWork> at_times = equal_times(rows), at_errors = equal_errors(rows);
  for (const auto& slice : largest_slices(rows)) {
    const CellName& name = slice.front()->name;
    text += fmt::format(
        "{}{}, {}, N = {}: efficiency 1/(rmse² · s) of {} timings each, and CPU time a sample, points alone beside it\n"
        "\n{}",
        text.empty() ? "" : "\n", name.scene, name.precision, name.samples, slice.front()->times.runs.size(),
        efficiency_table(slice));
    const EqualWork* errors = find_first(at_times, name);
    const EqualWork* times = find_first(at_errors, name);
    if (!errors || !times) continue;
    text += fmt::format(
        "\n{}, {}: rmse after {} an integral, the shortest time that N = {} takes, and time to an rmse of "
        "{:.3g}, the median after that time\n\n{}",
        name.scene, name.precision, time_text(errors->at), name.samples, times->at, equal_table(*errors, *times));
  }
  return text;
}

}  // namespace halfslope
