#include "experiments/measures.h"

#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <map>
#include <optional>

#include "core/atomic_file.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/point_block.h"
#include "experiments/interrupt.h"
#include "experiments/parallel.h"
#include "experiments/progress.h"

namespace halfslope {
namespace {

// Replicates travel in lanes, and all lanes of small sets are kept; of large ones fewer, so that a thread holds no more
// than so many coordinates, or one set.
constexpr std::uint64_t kHeld = std::uint64_t{1} << 19;
constexpr int kBlock = 256;
// Threads at work on sets above kHeld, each of which takes some hundred MB.
constexpr int kLargeAtOnce = 4;

/// Some replicates of a sampler's points at one N; of a sequence, at every N.
struct Task {
  std::size_t points;
  std::size_t first_count, end_count;  ///< positions in its counts
  std::int64_t first_replicate;
  int replicates;
};

std::uint64_t coordinates(const MeasuredPoints& points, std::size_t n) {
  return points.counts[n].count * static_cast<std::uint64_t>(points.layout.dims());
}

std::vector<Task> tasks_of(const MeasuresPlan& plan) {
  std::vector<Task> tasks;
  for (std::size_t p = 0; p < plan.points.size(); ++p) {
    const MeasuredPoints& points = plan.points[p];
    for (std::size_t first = 0; first < points.counts.size();) {
      const std::size_t end = points.sequence ? points.counts.size() : first + 1;
      const auto lanes = static_cast<int>(std::clamp<std::uint64_t>(kHeld / coordinates(points, end - 1), 1, kLanes));
      for (std::int64_t r = 0; r < points.replicates; r += lanes) {
        const auto replicates = static_cast<int>(std::min<std::int64_t>(lanes, points.replicates - r));
        tasks.push_back({p, first, end, r, replicates});
      }
      first = end;
    }
  }
  return tasks;
}

/// Coordinates of several replicates, each dimension of each in one piece.
class Columns {
 public:
  Columns(Sampler& sampler, const MeasuredPoints& points, const Task& task)
      : count_(points.counts[task.end_count - 1].count),
        dims_(points.layout.dims()),
        values_(count_ * static_cast<std::size_t>(task.replicates * dims_)) {
    sampler.prepare({count_, &points.layout, points.key, 0, static_cast<std::uint32_t>(task.first_replicate), true});
    PointBlock block;
    for (std::uint64_t begin = 0; begin < count_ && !interrupted(); begin += kBlock) {
      block.reset(dims_, static_cast<int>(std::min<std::uint64_t>(kBlock, count_ - begin)), true);
      sampler.fill(begin, block);
      for (int lane = 0; lane < task.replicates; ++lane) {
        for (int d = 0; d < dims_; ++d) {
          double* to = values_.data() + at(lane, d) + begin;
          for (int s = 0; s < block.samples(); ++s) to[s] = block.coordinate(d, s, lane);
        }
      }
    }
  }
  /// The first `count` points of a replicate.
  PointSet prefix(int lane, std::uint64_t count) const {
    std::vector<std::span<const double>> columns;
    for (int d = 0; d < dims_; ++d) columns.emplace_back(values_.data() + at(lane, d), count);
    return PointSet(std::move(columns));
  }

 private:
  std::size_t at(int lane, int dim) const { return static_cast<std::size_t>(lane * dims_ + dim) * count_; }

  std::size_t count_;
  int dims_;
  std::vector<double> values_;
};

/// Where the rows of each sampler's points begin.
std::vector<std::size_t> first_rows(const MeasuresPlan& plan) {
  std::vector<std::size_t> rows = {0};
  for (const MeasuredPoints& p : plan.points) rows.push_back(rows.back() + p.rows());
  return rows;
}

void measure(const MeasuresPlan& plan, const SamplerCatalogue& samplers, const Task& task,
             std::span<MeasuredValue> rows, Progress& progress) {
  const MeasuredPoints& points = plan.points[task.points];
  const auto by_net = [&](std::size_t m, std::uint64_t count) { return points.net_gives(plan.measures[m], count); };
  bool needs_points = false;
  for (std::size_t n = task.first_count; n < task.end_count; ++n) {
    for (const std::size_t m : points.counts[n].measures) needs_points |= !by_net(m, points.counts[n].count);
  }
  std::optional<Columns> columns;
  if (needs_points) columns.emplace(*samplers.make(points.sampler), points, task);
  std::size_t first = 0;  // row of the first replicate at this N
  for (std::size_t n = 0; n < task.first_count; ++n)
    first += points.counts[n].rows.size() * static_cast<std::size_t>(points.replicates);
  for (std::size_t n = task.first_count; n < task.end_count; ++n) {
    const MeasuredCount& counted = points.counts[n];
    // What follows from generator matrices is the same for all replicates.
    std::map<std::size_t, std::vector<MeasuredValue>> of_net;
    for (const std::size_t m : counted.measures) {
      if (by_net(m, counted.count)) of_net[m] = plan.measures[m].net_values(*points.matrices, counted.count);
    }
    for (int lane = 0; lane < task.replicates && !interrupted(); ++lane) {
      auto row =
          rows.begin() + static_cast<std::ptrdiff_t>(first + static_cast<std::size_t>(task.first_replicate + lane) *
                                                                 counted.rows.size());
      for (const std::size_t m : counted.measures) {
        const auto net = of_net.find(m);
        const auto values =
            net == of_net.end() ? plan.measures[m].values(columns->prefix(lane, counted.count)) : net->second;
        row = std::ranges::copy(values, row).out;
      }
      progress.advance(static_cast<double>(counted.count));
    }
    first += counted.rows.size() * static_cast<std::size_t>(points.replicates);
  }
}

double points_in_all(const MeasuresPlan& plan) {
  double sum = 0;
  for (const MeasuredPoints& p : plan.points) {
    for (const MeasuredCount& n : p.counts) sum += static_cast<double>(n.count) * static_cast<double>(p.replicates);
  }
  return sum;
}

}  // namespace

Measurements measure_points(const MeasuresPlan& plan, const SamplerCatalogue& samplers, int threads,
                            const std::string& label, bool quiet) {
  Measurements measured(plan.rows());
  if (measured.empty()) return measured;
  std::vector<Task> tasks = tasks_of(plan);
  const auto large = std::stable_partition(tasks.begin(), tasks.end(), [&](const Task& task) {
    return coordinates(plan.points[task.points], task.end_count - 1) <= kHeld;
  });
  const std::vector<std::size_t> rows = first_rows(plan);
  Progress progress(label, points_in_all(plan), quiet);
  const auto run = [&](auto begin, auto end) {
    tbb::parallel_for_each(begin, end, [&](const Task& task) {
      if (interrupted()) return;
      const std::size_t p = task.points;
      measure(plan, samplers, task, std::span(measured).subspan(rows[p], rows[p + 1] - rows[p]), progress);
    });
  };
  with_threads(threads, [&](int count) {
    run(tasks.begin(), large);
    tbb::task_arena(std::min(count, kLargeAtOnce)).execute([&] { run(large, tasks.end()); });
  });
  if (interrupted()) {
    fail(ExitCode::kInterrupted, "interrupted while points were measured");
  }
  progress.finish();
  return measured;
}

void visit_measurements(const MeasuresPlan& plan, const Measurements& measured, const VisitMeasurement& visit) {
  auto value = measured.begin();
  for (const MeasuredPoints& p : plan.points) {
    for (const MeasuredCount& n : p.counts) {
      for (std::int64_t r = 0; r < p.replicates; ++r) {
        for (const std::string& name : n.rows) visit(p, n.count, r, name, *value++);
      }
    }
  }
}

std::span<const std::string> discrepancy_columns() {
  static const std::vector<std::string> columns = {"sampler", "dims",  "count", "replicate", "measure",
                                                   "value",   "lower", "upper", "method"};
  return columns;
}

void write_discrepancy_csv(const std::filesystem::path& path, const MeasuresPlan& plan, const Measurements& measured) {
  if (plan.measures.empty()) return;
  constexpr int kRowsAtOnce = 4096;
  AtomicFile file(path);
  CsvWriter csv(discrepancy_columns());
  int rows = 0;
  visit_measurements(plan, measured,
                     [&](const MeasuredPoints& p, std::uint64_t count, std::int64_t replicate, const std::string& name,
                         const MeasuredValue& value) {
                       csv.row(p.sampler, p.layout.dims(), count, replicate, name, value.value, value.lower,
                               value.upper, value.method);
                       if (++rows % kRowsAtOnce == 0) file.write(csv.take_text());
                     });
  file.write(csv.take_text());  // the header alone where there are no rows
  file.commit();
}

}  // namespace halfslope
