#include "experiments/timing_results.h"

#include <algorithm>

#include "analysis/status.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

constexpr int kFurther = 2;  // times and errors beside the one that all lines have

template <class Number>
MedianEstimate median_of(const std::vector<TimedRun>& runs, const Number& number) {
  std::vector<double> values;
  for (const TimedRun& run : runs) values.push_back(number(run));
  return median_estimate(values);
}

/// The lines of one scene and precision.
struct Group {
  std::vector<CellName> names;
  std::vector<WorkCurve> curves;
};

std::vector<Group> groups_of(const std::vector<TimingResult>& rows) {
  std::vector<Group> groups;
  for (auto row = rows.begin(); row != rows.end();) {
    const auto end =
        std::find_if(row, rows.end(), [&](const TimingResult& r) { return !same_line(r.name, row->name); });
    auto group = std::ranges::find_if(groups, [&](const Group& g) {
      return g.names.front().scene == row->name.scene && g.names.front().precision == row->name.precision;
    });
    if (group == groups.end()) group = groups.insert(group, Group());
    std::vector<WorkPoint> points;
    group->names.push_back(row->name);
    group->names.back().samples = 0;
    for (; row != end; ++row) {
      if (!row->rmse && !row->exact) continue;
      points.push_back({static_cast<double>(row->name.samples), row->seconds(), row->rmse.value_or(PositiveEstimate()),
                        row->certified, row->covered()});
    }
    group->curves.emplace_back(std::move(points));
  }
  return groups;
}

using Ask = WorkAnswer (WorkCurve::*)(double) const;

EqualWork ask(const Group& group, Ask question, double at) {
  EqualWork work = {at, {}};
  for (std::size_t k = 0; k < group.names.size(); ++k)
    work.lines.push_back({group.names[k], (group.curves[k].*question)(at)});
  return work;
}

bool answered(const EqualWork& work) {
  return std::ranges::any_of(work.lines, [](const LineAnswer& l) { return l.answer.reach == Reach::kInside; });
}

/// The time that the fastest of the lines with the group's largest N takes for it, where an error is left.
std::optional<double> common_time(const Group& group) {
  double samples = 0, seconds = 0;
  for (const WorkCurve& curve : group.curves) {
    for (const WorkPoint& point : curve.points()) {
      if (point.rmse.value == 0) continue;
      if (point.samples > samples || (point.samples == samples && point.seconds.value < seconds))
        samples = point.samples, seconds = point.seconds.value;
    }
  }
  return samples > 0 ? std::optional(seconds) : std::nullopt;
}

/// The median of the lines' errors after that time; of an even number the smaller of the middle two.
std::optional<double> common_error(const Group& group) {
  const auto seconds = common_time(group);
  if (!seconds) return std::nullopt;
  std::vector<double> errors;
  for (const WorkCurve& curve : group.curves) {
    if (const WorkAnswer answer = curve.error_after(*seconds); answer.reach == Reach::kInside)
      errors.push_back(answer.value.value);
  }
  std::ranges::sort(errors);
  return errors[(errors.size() - 1) / 2];
}

std::vector<EqualWork> ask_all(const std::vector<TimingResult>& rows, Ask question,
                               std::optional<double> (*first)(const Group&), double step) {
  std::vector<EqualWork> answers;
  for (const Group& group : groups_of(rows)) {
    std::optional<double> at = first(group);
    for (int k = 0; at && k <= kFurther; ++k, *at *= step) {
      EqualWork work = ask(group, question, *at);
      if (k == 0 || answered(work)) answers.push_back(std::move(work));
    }
  }
  return answers;
}

}  // namespace

PositiveEstimate TimingResult::seconds() const {
  const double factor = static_cast<double>(name.samples) * 1e-9;
  return {all.median * factor, all.interval.lo * factor, all.interval.hi * factor};
}

bool TimingResult::covered() const { return all.coverage >= 0.95; }

std::string LineAnswer::status() const {
  if (answer.reach != Reach::kInside) return std::string(to_string(answer.reach));
  Status status;
  status.mark_if(!answer.certified, "uncertified");
  status.mark_if(!answer.covered, "few-repetitions");
  return status.text();
}

std::vector<TimingResult> timing_results(const Results& results, std::vector<CellTimes> times) {
  assert_equal(times.size(), results.cells.size(), "cells and their times");
  std::vector<TimingResult> rows;
  for (std::size_t c = 0; c < times.size(); ++c) {
    if (times[c].runs.empty()) continue;
    const CellResult& cell = results.cells[c];
    const CellStatistics& s = cell.statistics;
    TimingResult& row = rows.emplace_back();
    row.name = cell.name;
    row.times = std::move(times[c]);
    row.all = median_of(row.times.runs, [](const TimedRun& run) { return run.all_ns; });
    row.points = median_of(row.times.runs, [](const TimedRun& run) { return run.points_ns; });
    row.evaluation = median_of(row.times.runs, [](const TimedRun& run) { return run.all_ns - run.points_ns; });
    row.certified = is_certified(s.status);
    Status status;
    status.mark_if(s.status != "ok", s.status);
    status.mark_if(!row.covered(), "few-repetitions");
    row.status = status.text();
    row.exact = s.rmse == 0.0;
    if (!s.rmse || !(*s.rmse > 0)) continue;
    row.rmse = PositiveEstimate{*s.rmse, s.rmse_lo, s.rmse_hi};
    row.efficiency = efficiency(*row.rmse, row.seconds());
  }
  return rows;
}

std::vector<EqualWork> equal_times(const std::vector<TimingResult>& rows) {
  return ask_all(rows, &WorkCurve::error_after, common_time, 0.25);
}

std::vector<EqualWork> equal_errors(const std::vector<TimingResult>& rows) {
  return ask_all(rows, &WorkCurve::time_until, common_error, 2);
}

}  // namespace halfslope
