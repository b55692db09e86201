#include "analysis/rate_laws.h"

#include <fmt/format.h>

#include <cmath>

#include "analysis/moments.h"

namespace halfslope {
namespace {

std::vector<double> doubling(int first, int last) {
  std::vector<double> samples;
  for (int k = first; k <= last; ++k) samples.push_back(std::ldexp(1.0, k));
  return samples;
}

/// Normal numbers with correlation 0.6 between neighbours.
class Chain {
 public:
  explicit Chain(RunRandom& random) : random_(random), last_(random.normal()) {}
  double next() {
    const double value = last_;
    last_ = 0.6 * last_ + 0.8 * random_.normal();
    return value;
  }

 private:
  RunRandom& random_;
  double last_;
};

/// A law of single integrals: one replicate's error at each N, given those of all.
RateLaw of_errors(std::string name, double rate, std::vector<double> samples,
                  std::function<void(std::span<double> errors, std::span<const double> samples, RunRandom&)> draw) {
  return {std::move(name), rate, [samples = std::move(samples), draw](std::int64_t replicates, RunRandom& random) {
            RateData data{samples, {samples.size(), std::vector<double>(static_cast<std::size_t>(replicates))}};
            std::vector<double> errors(samples.size());
            for (std::size_t r = 0; r < static_cast<std::size_t>(replicates); ++r) {
              draw(errors, samples, random);
              for (std::size_t j = 0; j < errors.size(); ++j) data.mse[j][r] = errors[j] * errors[j];
            }
            return data;
          }};
}

}  // namespace

RateLaw walks(std::int64_t pixels, double reference_times) {
  const std::vector<double> samples = doubling(4, 10);
  const std::string name = (pixels == 1 ? "walks" : fmt::format("{} pixels of walks", pixels)) +
                           (reference_times > 0 ? fmt::format(", reference {}×", reference_times) : "");
  const auto draw = [=](std::int64_t replicates, RunRandom& random) {
    const auto r = static_cast<std::size_t>(replicates), p = static_cast<std::size_t>(pixels);
    RateData data{samples, {samples.size(), std::vector<double>(r)}};
    const double reference_mse = reference_times > 0 ? 1 / (reference_times * samples.back()) : 0;
    data.reference = {reference_mse, 2 * reference_mse * reference_mse / static_cast<double>(pixels)};
    data.variance.resize(samples.size());
    std::vector<std::vector<double>> errors(samples.size(), std::vector<double>(r));
    for (std::size_t pixel = 0; pixel < p; ++pixel) {
      const double reference = std::sqrt(reference_mse) * random.normal();
      for (std::size_t i = 0; i < r; ++i) {
        double sum = 0, taken = 0;
        for (std::size_t j = 0; j < samples.size(); ++j) {
          sum += std::sqrt(samples[j] - taken) * random.normal();
          taken = samples[j];
          const double error = errors[j][i] = sum / taken - reference;
          data.mse[j][i] += error * error / static_cast<double>(pixels);
        }
      }
      for (std::size_t j = 0; j < samples.size(); ++j) {
        Moments moments;
        moments.add(std::span<const double>(errors[j]));
        data.variance[j] += moments.variance() / static_cast<double>(pixels);
      }
    }
    return data;
  };
  return {name, -0.5, draw};
}

RateLaw owen_like(double large) {
  constexpr double kOften = 0.2;
  // The larger scale has the larger square s² with probability p, the other what makes the mean 1: E s⁴ = κ/3.
  const double rest = (1 - large * large * kOften) / (1 - kOften), small = std::sqrt(rest),
               kurtosis = 3 * (std::pow(large, 4) * kOften + rest * rest * (1 - kOften));
  return of_errors(fmt::format("Owen-like mixture, kurtosis {:.0f}", kurtosis), -1.5, doubling(4, 10),
                   [=](std::span<double> errors, std::span<const double> samples, RunRandom& random) {
                     Chain chain(random);
                     const auto drawn_scale = [&] { return random.uniform() < kOften ? large : small; };
                     double scale = drawn_scale();
                     for (std::size_t j = 0; j < errors.size(); ++j) {
                       errors[j] = scale * chain.next() * std::pow(samples[j], -1.5);
                       if (random.uniform() < 0.5) scale = drawn_scale();
                     }
                   });
}

RateLaw biased() {
  return of_errors("rate −1 with a bias", -1, doubling(4, 12),
                   [](std::span<double> errors, std::span<const double> samples, RunRandom& random) {
                     Chain chain(random);
                     for (std::size_t j = 0; j < errors.size(); ++j) errors[j] = chain.next() / samples[j] + 1.0 / 512;
                   });
}

RateLaw rounded() {
  return of_errors("rate −1 with rounding", -1, doubling(4, 12),
                   [](std::span<double> errors, std::span<const double> samples, RunRandom& random) {
                     Chain chain(random);
                     for (std::size_t j = 0; j < errors.size(); ++j)
                       errors[j] = chain.next() / samples[j] + random.normal() / 512;
                   });
}

RateLaw walk_spread() {
  const auto draw = [samples = doubling(4, 10)](std::int64_t replicates, RunRandom& random) {
    std::vector<std::vector<double>> errors(samples.size(), std::vector<double>(static_cast<std::size_t>(replicates)));
    for (std::size_t i = 0; i < errors[0].size(); ++i) {
      double sum = 0, taken = 0;
      for (std::size_t j = 0; j < samples.size(); ++j) {
        sum += std::sqrt(samples[j] - taken) * random.normal();
        taken = samples[j];
        errors[j][i] = sum / taken;
      }
    }
    RateData data{samples, {}};
    for (const std::vector<double>& at : errors) data.mse.push_back(spread_of(at));
    return data;
  };
  return {"walks, reference unknown", -0.5, draw};
}

std::vector<double> spread_of(const std::vector<double>& errors) {
  Moments moments;
  moments.add(std::span<const double>(errors));
  const auto n = static_cast<double>(errors.size());
  std::vector<double> spread;
  for (const double error : errors) spread.push_back((error - moments.mean) * (error - moments.mean) * n / (n - 1));
  return spread;
}

}  // namespace halfslope
