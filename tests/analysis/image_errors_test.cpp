#include "analysis/image_errors.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/analysis/cell_data_builder.h"

namespace halfslope {
namespace {

using testing::DoubleNear;

std::vector<std::vector<double>> noise(std::size_t images, const std::vector<double>& reference) {
  std::mt19937 random(11);
  std::vector<std::vector<double>> result(images, reference);
  for (auto& image : result) {
    for (double& value : image) value += 0.1 * (static_cast<double>(random()) * 0x1p-32 - 0.4);
  }
  return result;
}

const MetricValue& named(const std::vector<MetricValue>& values, std::string_view name) {
  for (std::size_t m = 0; m < values.size(); ++m) {
    if (image_metrics()[m].name == name) return values[m];
  }
  throw std::runtime_error("no such metric");
}

TEST(ImageErrorsTest, SumsAreThoseOfTheirDefinitions) {
  const std::vector<double> value = {0.5, 1, 0, 2, 0.25, 3}, variance = {1e-4, 0, 2e-4, 1e-3, 1e-5, 0};
  const auto images = noise(20, value);
  const ImageReference reference = {1, value, variance, {}, {}};
  ImageErrors errors(reference);
  for (const auto& image : images) errors.add(image);
  const CellData got = errors.data(5), expected = build_cell(images, value, variance);
  EXPECT_EQ(got.replicates, 20);
  EXPECT_EQ(got.integrals, 6);
  const auto near = [](double a, double b) { EXPECT_NEAR(a, b, 1e-13 * std::abs(b) + 1e-18); };
  near(got.mean.mean, expected.mean.mean);
  near(got.mean_error.central2, expected.mean_error.central2);
  near(got.mse.mean, expected.mse.mean);
  near(got.relmse.mean, expected.relmse.mean);
  near(got.mae, expected.mae);
  near(got.sum_m2, expected.sum_m2);
  near(got.sum_m2_squared, expected.sum_m2_squared);
  near(got.sum_m4, expected.sum_m4);
  near(got.reference_mean, expected.reference_mean);
  near(got.reference_mse, expected.reference_mse);
  near(got.reference_relmse, expected.reference_relmse);
  near(got.reference_se, expected.reference_se);  // one channel: pixels are independent
  EXPECT_EQ(got.abs_error.median(), expected.abs_error.median());
  ASSERT_EQ(got.per_replicate.size(), 20u);
  for (std::size_t r = 0; r < 20; ++r)
    near(got.per_replicate[r].max_abs_error, expected.per_replicate[r].max_abs_error);
}

// One image, worked by hand: R = (1, 2), I = (1.5, 1), errors 1/2 and −1.
TEST(ImageErrorsTest, MetricsAreTheirFormulas) {
  const ImageReference reference = {1, {1, 2}, {}, {}, {}};
  ImageErrors errors(reference);
  errors.add(std::vector<double>{1.5, 1});
  const CellData data = errors.data(1);
  const auto values = errors.metrics(data, summarise(data));
  EXPECT_THAT(*named(values, "mse").value, DoubleNear(0.625, 1e-15));
  EXPECT_THAT(*named(values, "rmse").value, DoubleNear(std::sqrt(0.625), 1e-15));
  EXPECT_THAT(*named(values, "mae").value, DoubleNear(0.75, 1e-15));
  EXPECT_THAT(*named(values, "relmse").value, DoubleNear((0.25 / 1.01 + 1 / 4.01) / 2, 1e-15));
  EXPECT_THAT(*named(values, "mrse").value, DoubleNear((0.25 / (1.01 * 1.01) + 1 / (2.01 * 2.01)) / 2, 1e-15));
  EXPECT_THAT(*named(values, "mape").value, DoubleNear((0.5 / 1.01 + 1 / 2.01) / 2, 1e-15));
  EXPECT_THAT(*named(values, "smape").value, DoubleNear((0.5 / 2.51 + 1 / 3.01) / 2, 1e-15));
  for (const MetricValue& value : values) EXPECT_FALSE(value.lo || value.hi);  // one replicate
}

TEST(ImageErrorsTest, SquaredMetricsLoseTheReferencesShareAndOthersCannot) {
  const std::vector<double> value = {0.5, 1, 2, 0}, variance = {1e-3, 2e-3, 0, 1e-3};
  const auto images = noise(16, value);
  const ImageReference noisy = {2, value, variance, {}, {}}, exact = {2, value, {}, {}, {}};
  ImageErrors a(noisy), b(exact);
  for (const auto& image : images) {
    a.add(image);
    b.add(image);
  }
  const CellData data_a = a.data(1), data_b = b.data(1);
  const auto with = a.metrics(data_a, summarise(data_a)), without = b.metrics(data_b, summarise(data_b));
  EXPECT_THAT(*named(with, "mse").value, DoubleNear(*named(without, "mse").value - 1e-3, 1e-15));
  const double share = (1e-3 / (0.51 * 0.51) + 2e-3 / (1.01 * 1.01) + 1e-3 / (0.01 * 0.01)) / 4;
  EXPECT_THAT(*named(with, "mrse").reference_share, DoubleNear(share, 1e-14));
  EXPECT_EQ(named(without, "mrse").reference_share, 0.0);
  EXPECT_EQ(named(with, "smape").value, named(without, "smape").value);
  EXPECT_FALSE(named(with, "smape").reference_share);
  // The channels of one pixel rise and fall together: pixel 0 has √1e-3 and √2e-3, pixel 1 0 and √1e-3.
  EXPECT_THAT(data_a.reference_se,
              DoubleNear(std::sqrt(std::pow(std::sqrt(1e-3) + std::sqrt(2e-3), 2) + 1e-3) / 4, 1e-15));
  EXPECT_THAT(data_a.reference_mse_noise, DoubleNear(2 * (3e-3 * 3e-3 + 1e-3 * 1e-3) / 16, 1e-18));
}

TEST(ImageErrorsTest, ANonFiniteValueIsCountedAndNeitherDroppedNorZeroed) {
  const ImageReference reference = {1, {1, 2}, {}, {}, {}};
  ImageErrors errors(reference);
  errors.add(std::vector<double>{1.5, 1});
  errors.add(std::vector<double>{std::numeric_limits<double>::quiet_NaN(), 1});
  const CellData data = errors.data(1);
  const CellStatistics statistics = summarise(data);
  EXPECT_EQ(statistics.nonfinite, 1);
  EXPECT_TRUE(statistics.invalid);
  EXPECT_FALSE(statistics.rmse);
  for (const MetricValue& value : errors.metrics(data, statistics)) EXPECT_FALSE(value.value);
}

TEST(ImageErrorsTest, ImagesThatAreTheReferenceAreExact) {
  const ImageReference reference = {1, {1, 2}, {}, {}, {}};
  ImageErrors errors(reference);
  for (int i = 0; i < 3; ++i) errors.add(std::vector<double>{1, 2});
  const CellData data = errors.data(1);
  for (const MetricValue& value : errors.metrics(data, summarise(data))) {
    EXPECT_EQ(value.value, 0.0);
    EXPECT_FALSE(value.lo);
  }
}

// (I − A)(I − B) by hand: (1 − 0)(1 − 2) = −1, (3 − 1)(3 − 2) = 2, so 1/2; the second image (2)(0) + (−1)(−2), so 1.
TEST(ImageErrorsTest, HalfBuffersMultiplyTheErrorsAgainstEach) {
  const ImageReference reference = {1, {1, 1.5}, {}, {0, 1}, {2, 2}};
  ImageErrors errors(reference);
  errors.add(std::vector<double>{1, 3});
  errors.add(std::vector<double>{2, 0});
  const auto value = errors.half_buffers(1);
  ASSERT_TRUE(value);
  EXPECT_THAT(*value->value, DoubleNear(0.75, 1e-15));
  const ImageReference whole = {1, {1, 1.5}, {}, {}, {}};
  EXPECT_FALSE(ImageErrors(whole).half_buffers(1));
}

// 2000 integrals of which the two worst, ⌈2000/1000⌉, err by 3 and 2 and all others by 1/10.
TEST(ImageErrorsTest, TheWorstPixelsShareOfTheError) {
  const ImageReference reference = {1, std::vector<double>(2000, 1), {}, {}, {}};
  std::vector<double> image(2000, 1.1);
  image[7] = 4;
  image[1999] = -1;
  ImageErrors errors(reference);
  errors.add(image);
  EXPECT_THAT(errors.data(1).worst_squared_error, DoubleNear(13, 1e-12));
  EXPECT_THAT(errors.data(1).other_squared_error, DoubleNear(1998 * 0.01, 1e-12));
}

}  // namespace
}  // namespace halfslope
