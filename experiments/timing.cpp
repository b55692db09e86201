#include "experiments/timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <map>
#include <memory>
#include <numeric>
#include <variant>

#include "core/error.h"
#include "core/random.h"
#include "estimators/pass_evaluator.h"
#include "experiments/interrupt.h"
#include "experiments/progress.h"

namespace halfslope {
namespace {

/// Long enough for a clock that is read in a fraction of a microsecond, and for what a run begins with.
constexpr double kLeastNs = 2e6;
constexpr std::uint64_t kMostPixels = 32, kFewestPixels = 4;
/// Samples of a sweep over the pixels that more of them must not exceed.
constexpr std::uint64_t kSweepSamples = std::uint64_t{1} << 19;
/// What an estimate before any timing reckons with.
constexpr double kGuessedNs = 20;

double thread_cpu_ns() {
  timespec now = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
}

struct Elapsed {
  double cpu_ns, wall_ns;
};

template <class Work>
Elapsed elapsed(const Work& work) {
  const auto wall = std::chrono::steady_clock::now();
  const double cpu = thread_cpu_ns();
  work();
  const double cpu_ns = thread_cpu_ns() - cpu;
  return {cpu_ns, std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - wall).count()};
}

std::uint64_t pixels_at(std::uint64_t samples) {
  return std::clamp<std::uint64_t>(kSweepSamples / (kLanes * samples), kFewestPixels, kMostPixels);
}

struct TimedPixel {
  std::uint32_t index;
  std::unique_ptr<Integral> integral;
};

/// At most `count` pixels that need sampling, one from each of so many equal runs of the measured ones.
std::vector<TimedPixel> choose_pixels(const PlannedScene& scene, std::uint64_t count) {
  std::vector<TimedPixel> chosen;
  const std::uint64_t total = scene.pixels.size(), runs = std::min(count, total);
  const StreamKey key = stream_key(0, "timing", "pixels");
  for (std::uint64_t k = 0; k < runs; ++k) {
    const std::uint64_t begin = k * total / runs, size = (k + 1) * total / runs - begin;
    const std::uint64_t first = (random_word(key, Draw::kHigh, 0, static_cast<std::uint32_t>(k), 0, 0) * size) >> 32;
    for (std::uint64_t i = 0; i < size; ++i) {
      const int pixel = scene.pixels[begin + (first + i) % size];
      PixelIntegral integral = scene.source->pixel(pixel);
      if (!integral.integral) continue;
      chosen.push_back({static_cast<std::uint32_t>(pixel), std::move(integral.integral)});
      break;
    }
  }
  return chosen;
}

/// A cell's own evaluator. It lives for one repetition: those of all cells at once could fill the memory.
class CellTimer {
 public:
  CellTimer(const Plan& plan, const Cell& cell, const SamplerCatalogue& samplers, const std::vector<TimedPixel>& pixels)
      : pass_(plan.passes[cell.pass]), pixels_(pixels) {
    const PlannedScene& scene = plan.scenes[cell.scene];
    const Heuristic& heuristic = scene.estimators[cell.estimator].heuristic;
    const std::uint64_t rounds = cell.samples / static_cast<std::uint64_t>(pass_.allocation.round());
    const auto make = [&]<class T>(T) {
      evaluator_ =
          std::make_unique<PassEvaluator<T>>(samplers.make(cell.sampler), scene.source->techniques(), pass_.allocation,
                                             std::vector{heuristic}, std::vector{rounds}, scene.source->channels());
    };
    cell.precision == Precision::kF32 ? make(float{}) : make(double{});
  }

  void make_points(int sweeps) {
    each(sweeps, [](auto& evaluator, const TimedPixel& pixel, StreamKey key, std::uint32_t replicate) {
      evaluator.make_points(key, pixel.index, replicate);
    });
  }
  void estimate(int sweeps) {
    each(sweeps, [](auto& evaluator, const TimedPixel& pixel, StreamKey key, std::uint32_t replicate) {
      evaluator.run(*pixel.integral, key, pixel.index, replicate);
    });
  }

 private:
  /// A sweep is a group of replicates of every pixel; further sweeps are of further replicates, as far as there are.
  template <class Work>
  void each(int sweeps, const Work& work) {
    const std::int64_t groups = (pass_.replicates + kLanes - 1) / kLanes;
    std::visit(
        [&](auto& evaluator) {
          for (const TimedPixel& pixel : pixels_) {
            for (std::int64_t sweep = 0; sweep < sweeps; ++sweep)
              work(*evaluator, pixel, pass_.key, static_cast<std::uint32_t>(sweep % groups * kLanes));
          }
        },
        evaluator_);
  }

  const Pass& pass_;
  const std::vector<TimedPixel>& pixels_;
  std::variant<std::unique_ptr<PassEvaluator<float>>, std::unique_ptr<PassEvaluator<double>>> evaluator_;
};

/// A cell in turn: its pixels, and the sweeps that fill a timed run.
struct Turn {
  const std::vector<TimedPixel>* pixels = nullptr;
  int sweeps = 1, point_sweeps = 1;
  double work_ns = 0;  ///< expected of one repetition
};

int sweeps_of(double sweep_ns) { return static_cast<int>(std::ceil(std::clamp(kLeastNs / sweep_ns, 1.0, 65536.0))); }

/// 0 … count − 1 in a random order (Fisher and Yates) that belongs to the repetition.
std::vector<std::size_t> shuffled(std::size_t count, int repetition) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const StreamKey key = stream_key(0, "timing", "order");
  for (std::size_t k = count; k > 1; --k) {
    const std::uint64_t word = random_word(key, Draw::kPermutation, 0, static_cast<std::uint32_t>(k),
                                           static_cast<std::uint32_t>(repetition), 0);
    std::swap(order[k - 1], order[(word * k) >> 32]);
  }
  return order;
}

void stop_if_interrupted() {
  if (interrupted()) fail(ExitCode::kInterrupted, "interrupted while estimators were timed");
}

/// Runs the cell once, as a warm-up, and sizes its timed runs.
void size_turn(Turn& turn, CellTimer timer) {
  timer.estimate(1);
  const double all = elapsed([&] { timer.estimate(1); }).cpu_ns;
  const double points = elapsed([&] { timer.make_points(1); }).cpu_ns;
  turn.sweeps = sweeps_of(all);
  // Points that cost next to nothing are not repeated for ever.
  turn.point_sweeps = std::min(sweeps_of(points), 8 * turn.sweeps);
  turn.work_ns = (turn.sweeps + 1) * all + turn.point_sweeps * points;
}

TimedRun time_once(const Turn& turn, const Cell& cell, CellTimer timer) {
  timer.estimate(1);
  const auto samples = static_cast<double>(turn.pixels->size() * kLanes * cell.samples);
  const Elapsed points = elapsed([&] { timer.make_points(turn.point_sweeps); });
  const Elapsed all = elapsed([&] { timer.estimate(turn.sweeps); });
  return {points.cpu_ns / (turn.point_sweeps * samples), all.cpu_ns / (turn.sweeps * samples),
          all.wall_ns / (turn.sweeps * samples)};
}

}  // namespace

std::vector<CellTimes> time_cells(const Plan& plan, const SamplerCatalogue& samplers, int repetitions,
                                  const std::string& label, bool quiet) {
  std::vector<CellTimes> times(plan.cells.size());
  std::vector<Turn> turns(plan.cells.size());
  std::map<std::pair<std::size_t, std::uint64_t>, std::vector<TimedPixel>> pixels;  // by scene and how many
  double work_ns = 0;
  for (std::size_t c = 0; c < plan.cells.size(); ++c) {
    stop_if_interrupted();
    const Cell& cell = plan.cells[c];
    const std::uint64_t count = pixels_at(cell.samples);
    auto [chosen, is_new] = pixels.try_emplace({cell.scene, count});
    if (is_new) chosen->second = choose_pixels(plan.scenes[cell.scene], count);
    turns[c].pixels = &chosen->second;
    if (chosen->second.empty()) continue;
    size_turn(turns[c], CellTimer(plan, cell, samplers, chosen->second));
    work_ns += turns[c].work_ns;
    times[c].pixels = static_cast<int>(chosen->second.size());
    times[c].estimates = chosen->second.size() * kLanes * static_cast<std::uint64_t>(turns[c].sweeps);
  }
  Progress progress(label, work_ns * repetitions, quiet);
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    for (const std::size_t c : shuffled(turns.size(), repetition)) {
      stop_if_interrupted();
      if (turns[c].pixels->empty()) continue;
      const Cell& cell = plan.cells[c];
      times[c].runs.push_back(time_once(turns[c], cell, CellTimer(plan, cell, samplers, *turns[c].pixels)));
      progress.advance(turns[c].work_ns);
    }
  }
  progress.finish();
  return times;
}

std::string describe_timing(const Plan& plan, int repetitions) {
  if (repetitions == 0) return "";
  double seconds = 0;
  for (const Cell& cell : plan.cells) {
    const std::uint64_t pixels =
        std::min<std::uint64_t>(pixels_at(cell.samples), plan.scenes[cell.scene].pixels.size());
    const double sweep = static_cast<double>(pixels * kLanes * cell.samples) * kGuessedNs;
    seconds += 1e-9 * repetitions * (2 * std::max(sweep, kLeastNs) + sweep);
  }
  return fmt::format("timed: {} cells x {} repetitions in turns on one thread, about {:.2g} s at {} ns a sample\n",
                     plan.cells.size(), repetitions, seconds, kGuessedNs);
}

}  // namespace halfslope
