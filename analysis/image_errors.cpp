#include "analysis/image_errors.h"

#include <cmath>

#include "analysis/compensated_sum.h"
#include "analysis/half_buffers.h"
#include "analysis/reference_noise.h"
#include "analysis/tails.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

double mean_of(const std::vector<double>& values) {
  CompensatedSum sum;
  for (const double value : values) sum.add(value);
  return values.empty() ? 0 : sum.value() / static_cast<double>(values.size());
}

double mean_standard_error(const ImageReference& reference) {
  if (reference.variance.empty()) return 0;
  CompensatedSum sum;
  for (std::size_t p = 0; p < reference.variance.size(); p += reference.channels) {
    double deviation = 0;
    for (std::size_t c = 0; c < reference.channels; ++c) deviation += std::sqrt(reference.variance[p + c]);
    sum.add(deviation * deviation);
  }
  return std::sqrt(sum.value()) / static_cast<double>(reference.value.size());
}

}  // namespace

double ImageReference::mean_variance() const { return mean_of(variance); }

ImageErrors::ImageErrors(const ImageReference& reference)
    : reference_(reference), integrals_(reference.value.size()), metrics_(image_metrics().size()) {
  assert_equal(reference.value.empty(), false, "a reference without integrals");
  assert_equal(reference.value.size() % reference.channels, std::size_t{0}, "integrals beyond the last whole channel");
  for (const auto* other : {&reference.variance, &reference.half_a, &reference.half_b})
    assert_equal(other->empty() || other->size() == reference.value.size(), true, "a reference of one length");
  assert_equal(reference.half_a.size(), reference.half_b.size(), "integrals of a reference's halves");
}

void ImageErrors::add(std::span<const double> image) {
  assert_equal(image.size(), reference_.value.size(), "integrals of an image");
  const auto integrals = static_cast<double>(image.size());
  CompensatedSum value, error, square, relative, magnitude;
  ReplicateErrors errors;
  for (std::size_t p = 0; p < image.size(); ++p) {
    const double truth = reference_.value[p], e = image[p] - truth, size = std::abs(e);
    value.add(image[p]);
    error.add(e);
    square.add(e * e);
    relative.add(e * e / (truth * truth + 0.01));
    magnitude.add(size);
    if (size > errors.max_abs_error || std::isnan(size)) errors.max_abs_error = size;
    abs_error_.add(e);
    nonfinite_ += std::isfinite(image[p]) ? 0 : 1;
    integrals_[p].add(image[p]);
  }
  errors.mean = value.value() / integrals;
  errors.mean_error = error.value() / integrals;
  errors.mse = square.value() / integrals;
  errors.relmse = relative.value() / integrals;
  errors.mae = magnitude.value() / integrals;
  replicates_.push_back(errors);
  if (!reference_.half_a.empty())
    half_buffer_mse_.push_back(half_buffer_mse(image, reference_.half_a, reference_.half_b));
  for (std::size_t m = 0; m < metrics_.size(); ++m) {
    CompensatedSum sum;
    const auto term = image_metrics()[m].term;
    for (std::size_t p = 0; p < image.size(); ++p) sum.add(term(image[p], reference_.value[p]));
    metrics_[m].push_back(sum.value() / integrals);
  }
}

ReferencePart ImageErrors::share(double (*weight)(double)) const {
  if (reference_.variance.empty()) return {};
  std::vector<double> weights;
  CompensatedSum sum;
  for (std::size_t p = 0; p < reference_.variance.size(); ++p) {
    weights.push_back(weight(reference_.value[p]));
    sum.add(reference_.variance[p] * weights.back());
  }
  return {sum.value() / static_cast<double>(weights.size()),
          mean_square_noise(reference_.variance, reference_.channels, weights)};
}

std::optional<MetricValue> ImageErrors::half_buffers(std::uint64_t seed) const {
  if (half_buffer_mse_.empty()) return std::nullopt;
  const HalfBuffers halves = compare_halves(reference_.half_a, reference_.half_b, reference_.channels);
  const HalfBufferMse result = half_buffer_interval(half_buffer_mse_, halves, seed);
  return MetricValue{std::isfinite(result.mse) ? std::optional(result.mse) : std::nullopt, result.lo, result.hi, {}};
}

CellData ImageErrors::data(std::uint64_t bootstrap_seed) const {
  CellData data;
  data.replicates = static_cast<std::int64_t>(replicates_.size());
  data.integrals = static_cast<std::int64_t>(integrals_.size());
  data.per_replicate = replicates_;
  CompensatedSum mae, m2, m2_squared, m4, worst_sum;
  for (const ReplicateErrors& errors : replicates_) {
    data.mean.add(errors.mean);
    data.mean_error.add(errors.mean_error);
    data.mse.add(errors.mse);
    data.relmse.add(errors.relmse);
    mae.add(errors.mae);
  }
  data.mae = mae.value() / static_cast<double>(data.replicates);
  std::vector<double> worst;
  for (std::size_t p = 0; p < integrals_.size(); ++p) {
    const Moments& m = integrals_[p];
    worst.push_back(mean_squared_error(m, reference_.value[p]));
    m2.add(m.m2());
    m2_squared.add(m.m2() * m.m2());
    m4.add(m.m4());
  }
  data.other_squared_error = keep_largest(worst, worst_count(data.integrals));
  for (const double squared : worst) worst_sum.add(squared);
  data.worst_squared_error = worst_sum.value();
  data.sum_m2 = m2.value();
  data.sum_m2_squared = m2_squared.value();
  data.sum_m4 = m4.value();
  data.abs_error = abs_error_;
  data.nonfinite = nonfinite_;
  data.reference_mean = mean_of(reference_.value);
  data.reference_mse = reference_.mean_variance();
  data.reference_se = mean_standard_error(reference_);
  const ReferencePart plain = share([](double) { return 1.0; });
  const ReferencePart relative = share([](double r) { return 1 / (r * r + 0.01); });
  data.reference_mse_noise = plain.noise;
  data.reference_relmse = relative.mean;
  data.reference_relmse_noise = relative.noise;
  data.bootstrap_seed = bootstrap_seed;
  return data;
}

std::vector<MetricValue> ImageErrors::metrics(const CellData& data, const CellStatistics& statistics) const {
  const bool exact = data.nonfinite == 0 && data.mae == 0;
  std::vector<MetricValue> values;
  for (std::size_t m = 0; m < metrics_.size(); ++m) {
    const ImageMetric& metric = image_metrics()[m];
    const std::optional<MetricValue> known = metric_of(metric, data, statistics);
    const ReferencePart of_reference = metric.weight ? share(metric.weight) : ReferencePart();
    values.push_back(known ? *known : metric_value(metric, metrics_[m], of_reference, exact, data.bootstrap_seed + m));
  }
  return values;
}

}  // namespace halfslope
