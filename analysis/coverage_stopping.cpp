#include "analysis/coverage_stopping.h"

#include <Random123/philox.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <optional>
#include <thread>
#include <utility>

#include "analysis/stopping.h"

namespace halfslope {
namespace {

constexpr std::int64_t kMost = 4096;
constexpr double kSigma = 1.5;  // of the logarithm of lognormal values

/// The errors of one run: independent of every other run's, and of how many threads there are.
class Errors {
 public:
  Errors(StoppingLaw law, std::uint64_t seed, std::uint64_t run) : law_(law), key_{{seed}}, run_(run) {}

  double next() {
    if (spare_) return law_of(std::exchange(spare_, std::nullopt).value());
    const auto words = r123::Philox2x64()({{counter_++, run_}}, key_);
    // Box and Muller's pair of normal variates, of u in (0, 1] and v in [0, 1).
    const double u = (static_cast<double>(words[0] >> 11) + 1) * 0x1p-53,
                 v = static_cast<double>(words[1] >> 11) * 0x1p-53;
    const double radius = std::sqrt(-2 * std::log(u)), angle = 2 * std::numbers::pi * v;
    spare_ = radius * std::sin(angle);
    return law_of(radius * std::cos(angle));
  }

 private:
  double law_of(double normal) const {
    return law_ == StoppingLaw::kGaussian ? normal : std::exp(kSigma * normal) - std::exp(kSigma * kSigma / 2);
  }

  StoppingLaw law_;
  r123::Philox2x64::key_type key_;
  std::uint64_t run_, counter_ = 0;
  std::optional<double> spare_;
};

double true_mse(StoppingLaw law) {
  const double s = kSigma * kSigma;
  return law == StoppingLaw::kGaussian ? 1 : std::expm1(s) * std::exp(s);
}

/// A cell whose errors are those of a simulated image, grown stage by stage.
class SimulatedCell {
 public:
  SimulatedCell(StoppingLaw law, int pixels, std::uint64_t seed, std::uint64_t run)
      : errors_(law, seed, run), pixels_(static_cast<std::size_t>(pixels)) {
    data_.integrals = pixels;
    data_.bootstrap_seed = run;
  }

  CellStatistics at(std::int64_t replicates) {
    for (; data_.replicates < replicates; ++data_.replicates) {
      ReplicateErrors image;
      for (Moments& pixel : pixels_) {
        const double error = errors_.next();
        pixel.add(error);
        image.mse += error * error / static_cast<double>(pixels_.size());
        data_.mae += std::abs(error);  // not a mean; only that it is not 0 is looked at
      }
      data_.mse.add(image.mse);
      data_.per_replicate.push_back(image);
    }
    data_.sum_m2 = data_.sum_m2_squared = data_.sum_m4 = 0;
    for (const Moments& pixel : pixels_) {
      data_.sum_m2 += pixel.m2();
      data_.sum_m2_squared += pixel.m2() * pixel.m2();
      data_.sum_m4 += pixel.m4();
    }
    return summarise(data_);
  }

 private:
  Errors errors_;
  std::vector<Moments> pixels_;
  CellData data_;
};

struct Stopped {
  CellStatistics cell;
  std::int64_t replicates;
};

Stopped run_until(SimulatedCell cell, double target) {
  for (const std::int64_t replicates : replicate_schedule(kMost)) {
    const CellStatistics statistics = cell.at(replicates);
    if (replicates == kMost || target_state(statistics, target) == TargetState::kReached)
      return {statistics, replicates};
  }
  return {};
}

}  // namespace

CoverageRow stopping_coverage(StoppingLaw law, int pixels, double target, const CoverageRequest& request) {
  const double truth = std::sqrt(true_mse(law));
  // Whole numbers and a sum over runs: the same for any threads.
  std::vector<double> widths(static_cast<std::size_t>(request.runs));
  std::atomic<std::int64_t> next = 0, done = 0, covered = 0, missed = 0, replicates = 0;
  std::atomic<bool> stopped = false;
  const auto work = [&] {
    for (std::int64_t run = next++; run < request.runs && !stopped; run = next++) {
      const auto [cell, used] =
          run_until(SimulatedCell(law, pixels, request.seed, static_cast<std::uint64_t>(run)), target);
      covered += cell.rmse_lo && cell.rmse_hi && *cell.rmse_lo <= truth && truth <= *cell.rmse_hi;
      missed += target_state(cell, target) != TargetState::kReached;
      replicates += used;
      if (cell.rmse_lo && cell.rmse_hi) widths[static_cast<std::size_t>(run)] = std::log(*cell.rmse_hi / *cell.rmse_lo);
      ++done;
      if (request.progress && !request.progress(1 / static_cast<double>(request.runs))) stopped = true;
    }
  };
  const unsigned threads =
      request.threads > 0 ? static_cast<unsigned>(request.threads) : std::max(1u, std::thread::hardware_concurrency());
  {
    std::vector<std::jthread> others;
    for (unsigned t = 1; t < threads; ++t) others.emplace_back(work);
    work();
  }
  CoverageRow row;
  row.number = "rmse";
  row.method = fmt::format("bootstrap-t, stopped at ±{:g} %", 100 * target);
  const char* name = law == StoppingLaw::kGaussian ? "Gaussian" : "lognormal(1.5)";
  row.law = pixels == 1 ? name : fmt::format("{} pixels of {}", pixels, name);
  row.runs = done;
  if (row.runs == 0) return row;
  const auto runs = static_cast<double>(row.runs);
  row.replicates = std::llround(static_cast<double>(replicates) / runs);
  row.covered = covered;
  for (const double width : widths) row.width += width / runs;
  row.marked = static_cast<double>(missed) / runs;
  return row;
}

std::vector<CoverageRow> stopping_coverage(const CoverageRequest& request) {
  struct Case {
    StoppingLaw law;
    int pixels;
    double target;
  };
  // At ±8 % of one Gaussian integral nearly all runs stop at the same stage; at ±9 % some stop one before, those whose
  // errors happen to look alike, which costs the most.
  constexpr Case kCases[] = {
      {StoppingLaw::kGaussian, 1, 0.10},  {StoppingLaw::kGaussian, 1, 0.09},  {StoppingLaw::kGaussian, 1, 0.08},
      {StoppingLaw::kGaussian, 1, 0.05},  {StoppingLaw::kGaussian, 16, 0.02}, {StoppingLaw::kGaussian, 256, 0.01},
      {StoppingLaw::kLognormal, 1, 0.10},
  };
  std::vector<CoverageRow> rows;
  for (const Case& c : kCases) {
    CoverageRequest part = request;
    if (request.progress) part.progress = [&](double share) { return request.progress(share / std::size(kCases)); };
    rows.push_back(stopping_coverage(c.law, c.pixels, c.target, part));
    if (rows.back().runs < request.runs) break;
  }
  return rows;
}

}  // namespace halfslope
