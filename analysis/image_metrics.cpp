#include "analysis/image_metrics.h"

#include <array>
#include <cmath>

#include "analysis/intervals.h"
#include "analysis/reference_noise.h"

namespace halfslope {
namespace {

double squared(double image, double reference) { return (image - reference) * (image - reference); }
double one(double /*reference*/) { return 1; }
double relative_weight(double reference) { return 1 / (reference * reference + 0.01); }
double shifted_weight(double reference) { return 1 / ((reference + 0.01) * (reference + 0.01)); }

constexpr std::array kMetrics = {
    ImageMetric{"mse", 1, MetricKind::kSquared, "(I - R)^2", "docs/columns.md", squared, one},
    ImageMetric{"rmse", 1, MetricKind::kRooted, "(I - R)^2, the root of its mean", "docs/columns.md", squared, one},
    ImageMetric{"mae", 1, MetricKind::kAbsolute, "|I - R|", "docs/columns.md",
                [](double image, double reference) { return std::abs(image - reference); }, nullptr},
    ImageMetric{
        "relmse", 1, MetricKind::kSquared, "(I - R)^2 / (R^2 + 0.01)",
        "after Rousselle, Knaus & Zwicker, Adaptive Sampling and Reconstruction using Greedy Error Minimization, 2011",
        [](double image, double reference) { return squared(image, reference) * relative_weight(reference); },
        relative_weight},
    ImageMetric{"mrse", 1, MetricKind::kSquared, "(I - R)^2 / (R + 0.01)^2", "pbrt-v4, imgtool diff --metric MRSE",
                [](double image, double reference) { return squared(image, reference) * shifted_weight(reference); },
                shifted_weight},
    ImageMetric{
        "mape", 1, MetricKind::kAbsolute, "|I - R| / (|R| + 0.01)", "mean absolute percentage error, as a fraction",
        [](double image, double reference) { return std::abs(image - reference) / (std::abs(reference) + 0.01); },
        nullptr},
    ImageMetric{"smape", 1, MetricKind::kAbsolute, "|I - R| / (|I| + |R| + 0.01)",
                "after Vogels et al., Denoising with Kernel Prediction and Asymmetric Loss Functions, 2018; at most 1",
                [](double image, double reference) {
                  return std::abs(image - reference) / (std::abs(image) + std::abs(reference) + 0.01);
                },
                nullptr}};

std::optional<double> square(const std::optional<double>& root) {
  return root ? std::optional(*root * *root) : std::nullopt;
}

}  // namespace

std::span<const ImageMetric> image_metrics() { return kMetrics; }

MetricValue metric_value(const ImageMetric& metric, std::span<const double> replicates, const ReferencePart& reference,
                         bool exact, std::uint64_t seed) {
  const bool squared = metric.kind != MetricKind::kAbsolute;
  const ReferencePart part = squared ? reference : ReferencePart();
  const std::optional<double> share = squared ? std::optional(part.mean) : std::nullopt;
  if (exact && part.mean == 0) return {0.0, {}, {}, share};
  Moments moments;
  moments.add(replicates);
  CorrectedMean result = corrected_mean(moments.mean, log_mean_bootstrap_t(replicates, seed), part);
  if (metric.kind == MetricKind::kRooted) result = rooted(result);
  return {result.value, result.lo, result.hi, share};
}

std::optional<MetricValue> metric_of(const ImageMetric& metric, const CellData& data, const CellStatistics& s) {
  if (metric.name == "mse") return MetricValue{square(s.rmse), square(s.rmse_lo), square(s.rmse_hi), s.reference_mse};
  if (metric.name == "rmse") return MetricValue{s.rmse, s.rmse_lo, s.rmse_hi, s.reference_mse};
  if (metric.name == "relmse") return MetricValue{s.relmse, s.relmse_lo, s.relmse_hi, data.reference_relmse};
  return std::nullopt;
}

}  // namespace halfslope
