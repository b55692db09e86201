#include "analysis/image_errors.h"

#include <cmath>

#include "analysis/compensated_sum.h"
#include "core/assertion.h"

namespace halfslope {
namespace {

double mean_of(const std::vector<double>& values) {
  CompensatedSum sum;
  for (const double value : values) sum.add(value);
  return values.empty() ? 0 : sum.value() / static_cast<double>(values.size());
}

/// The mean over the integrals of Var(R̂_p) · weight(R̂_p).
double reference_share(const ImageReference& reference, double (*weight)(double)) {
  CompensatedSum sum;
  for (std::size_t p = 0; p < reference.variance.size(); ++p)
    sum.add(reference.variance[p] * weight(reference.value[p]));
  return sum.value() / static_cast<double>(reference.value.size());
}

double mean_standard_error(const ImageReference& reference) {
  if (reference.variance.empty()) return 0;
  const std::size_t pixels = reference.value.size() / reference.channels;
  CompensatedSum sum;
  for (std::size_t i = 0; i < pixels; ++i) {
    double deviation = 0;
    for (std::size_t p = i; p < reference.value.size(); p += pixels) deviation += std::sqrt(reference.variance[p]);
    sum.add(deviation * deviation);
  }
  return std::sqrt(sum.value()) / static_cast<double>(reference.value.size());
}

}  // namespace

double ImageReference::mean_variance() const { return mean_of(variance); }

MetricValue half_buffer_metric(std::span<const double> half_buffer_mse) {
  Moments moments;
  moments.add(half_buffer_mse);
  MetricValue result;
  if (std::isfinite(moments.mean)) result.value = moments.mean;
  if (const auto interval = t_interval(moments)) {
    result.lo = interval->lo;
    result.hi = interval->hi;
  }
  return result;
}

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
  CompensatedSum value, error, square, relative, magnitude, product;
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
    if (!reference_.half_a.empty()) product.add((image[p] - reference_.half_a[p]) * (image[p] - reference_.half_b[p]));
  }
  errors.mean = value.value() / integrals;
  errors.mean_error = error.value() / integrals;
  errors.mse = square.value() / integrals;
  errors.relmse = relative.value() / integrals;
  errors.mae = magnitude.value() / integrals;
  replicates_.push_back(errors);
  if (!reference_.half_a.empty()) half_buffer_mse_.push_back(product.value() / integrals);
  for (std::size_t m = 0; m < metrics_.size(); ++m) {
    CompensatedSum sum;
    const auto term = image_metrics()[m].term;
    for (std::size_t p = 0; p < image.size(); ++p) sum.add(term(image[p], reference_.value[p]));
    metrics_[m].push_back(sum.value() / integrals);
  }
}

CellData ImageErrors::data(std::uint64_t bootstrap_seed) const {
  CellData data;
  data.replicates = static_cast<std::int64_t>(replicates_.size());
  data.integrals = static_cast<std::int64_t>(integrals_.size());
  data.per_replicate = replicates_;
  CompensatedSum mae, m2, m2_squared, m4;
  for (const ReplicateErrors& errors : replicates_) {
    data.mean.add(errors.mean);
    data.mean_error.add(errors.mean_error);
    data.mse.add(errors.mse);
    data.relmse.add(errors.relmse);
    mae.add(errors.mae);
  }
  data.mae = mae.value() / static_cast<double>(data.replicates);
  for (const Moments& m : integrals_) {
    m2.add(m.m2());
    m2_squared.add(m.m2() * m.m2());
    m4.add(m.m4());
  }
  data.sum_m2 = m2.value();
  data.sum_m2_squared = m2_squared.value();
  data.sum_m4 = m4.value();
  data.abs_error = abs_error_;
  data.nonfinite = nonfinite_;
  data.reference_mean = mean_of(reference_.value);
  data.reference_mse = reference_.mean_variance();
  data.reference_se = mean_standard_error(reference_);
  data.reference_relmse = reference_share(reference_, [](double r) { return 1 / (r * r + 0.01); });
  data.bootstrap_seed = bootstrap_seed;
  return data;
}

std::vector<MetricValue> ImageErrors::metrics(const CellData& data, const CellStatistics& statistics) const {
  const bool exact = data.nonfinite == 0 && data.mae == 0;
  std::vector<MetricValue> values;
  for (std::size_t m = 0; m < metrics_.size(); ++m) {
    const ImageMetric& metric = image_metrics()[m];
    const std::optional<MetricValue> known = metric_of(metric, data, statistics);
    const double share = metric.weight ? reference_share(reference_, metric.weight) : 0;
    values.push_back(known ? *known : metric_value(metric, metrics_[m], share, exact, data.bootstrap_seed + m));
  }
  return values;
}

}  // namespace halfslope
