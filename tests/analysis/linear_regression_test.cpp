#include "analysis/linear_regression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "analysis/moments.h"
#include "tests/analysis/nist_linear.h"
#include "tests/analysis/nist_univariate.h"

namespace halfslope {
namespace {

/// Log relative error, −log10 of it: the correct digits; 17, more than binary64 holds, for the nearest binary64. Where
/// the truth is 0 the error is absolute.
double correct_digits(double found, double exact) {
  if (found == exact) return 17;
  return -std::log10(std::abs(found - exact) / (exact == 0 ? 1 : std::abs(exact)));
}

/// The fewest over the numbers.
double correct_digits(const std::vector<double>& found, const std::vector<double>& exact) {
  EXPECT_EQ(found.size(), exact.size());
  double digits = 17;
  for (std::size_t i = 0; i < exact.size(); ++i) digits = std::min(digits, correct_digits(found[i], exact[i]));
  return digits;
}

LinearFit fit(const nist::LinearDataset& data) {
  const auto result = data.degree > 0 ? fit_polynomial(data.x[0], data.y, data.degree, data.intercept)
                                      : fit_linear(data.x, data.y, data.intercept);
  EXPECT_TRUE(result) << data.name;
  return result.value_or(LinearFit{std::vector<double>(data.coefficients.size()), {}, 0, 0});
}

TEST(LinearRegression, CoefficientsOfNistReferenceData) {
  // What NIST's own report and common packages in binary64 reach; Filip's columns differ by 1e-15 of their size.
  const auto least = [](const std::string& name) {
    if (name == "Filip") return 7.0;
    if (name == "Longley") return 10.0;
    if (name == "Norris" || name == "Pontius") return 12.0;
    if (name.starts_with("NoInt")) return 15.0;
    if (name == "Wampler1" || name == "Wampler2" || name == "Wampler3") return 9.0;
    return name == "Wampler4" ? 8.0 : 6.0;
  };
  for (const nist::LinearDataset& data : nist::kLinear) {
    const LinearFit found = fit(data);
    const double digits = correct_digits(found.coefficients, data.coefficients);
    EXPECT_GE(digits, least(data.name)) << data.name;
    RecordProperty(data.name, std::to_string(digits));
  }
}

TEST(LinearRegression, StandardErrorsOfNistReferenceData) {
  for (const nist::LinearDataset& data : nist::kLinear) {
    const std::string name = data.name;
    if (data.residual_sd == 0) {  // an exact polynomial: the residuals are rounding alone
      EXPECT_LT(fit(data).residual_sd, 1e-9 * std::abs(data.y.back())) << name;
      continue;
    }
    const LinearFit found = fit(data);
    const double least = name == "Filip" ? 7 : 9;
    EXPECT_GE(correct_digits(found.standard_errors, data.standard_errors), least) << name;
    EXPECT_GE(correct_digits(found.residual_sd, data.residual_sd), least) << name;
  }
}

TEST(LinearRegression, ALineThroughTwoPointsIsExactAndHasNoErrors) {
  const auto line = fit_linear(std::vector<std::vector<double>>{{1, 3}}, std::vector<double>{5, 1});
  ASSERT_TRUE(line);
  EXPECT_DOUBLE_EQ(line->coefficients[0], 7);
  EXPECT_DOUBLE_EQ(line->coefficients[1], -2);
  EXPECT_TRUE(line->standard_errors.empty());
}

TEST(LinearRegression, IsEmptyWhereNothingIsDetermined) {
  const std::vector<double> y = {1, 2, 4};
  EXPECT_FALSE(fit_linear(std::vector<std::vector<double>>{{2, 2, 2}}, y));             // the constant again
  EXPECT_FALSE(fit_linear(std::vector<std::vector<double>>{{1, 2, 3}, {2, 4, 6}}, y));  // one twice the other
  EXPECT_FALSE(fit_linear(std::vector<std::vector<double>>{{0, 0, 0}}, y, false));
  EXPECT_FALSE(fit_linear(std::vector<std::vector<double>>{{1, NAN, 3}}, y));
  EXPECT_FALSE(fit_polynomial(y, y, 3));
}

TEST(Autocorrelation, OfNistReferenceData) {
  EXPECT_GE(correct_digits(autocorrelation(nist::kLottery.values), -0.120948622967392867652), 15);
  EXPECT_GE(correct_digits(autocorrelation(nist::kLew.values), -0.307304800605679454862), 15);
  EXPECT_GE(correct_digits(autocorrelation(nist::kMavro.values), 0.937989183438248071637), 13);
  EXPECT_GE(correct_digits(autocorrelation(nist::kMichelson.values), 0.535199668621283315858), 13);
  EXPECT_GE(correct_digits(autocorrelation(std::vector<double>{10000001, 10000003, 10000002}), -0.5), 15);
  const auto accuracy_set = [](double first, double low, double high) {
    std::vector<double> values = {first};
    for (int i = 0; i < 500; ++i) values.insert(values.end(), {low, high});
    return values;
  };
  EXPECT_GE(correct_digits(autocorrelation(accuracy_set(1.2, 1.1, 1.3)), -0.999), 14);
  // The decimals are 1e-17 of 1e6 and 1e7 off when they become binary64, beside a spread of 0.1.
  EXPECT_GE(correct_digits(autocorrelation(accuracy_set(1000000.2, 1000000.1, 1000000.3)), -0.999), 9);
  EXPECT_GE(correct_digits(autocorrelation(accuracy_set(10000000.2, 10000000.1, 10000000.3)), -0.999), 8);
}

TEST(Autocorrelation, ByHand) {
  const std::vector<double> values = {1, 2, 3};  // deviations −1, 0, 1
  EXPECT_EQ(autocorrelation(values, 0), 1);
  EXPECT_EQ(autocorrelation(values, 1), 0);
  EXPECT_EQ(autocorrelation(values, 2), -0.5);
  EXPECT_TRUE(std::isnan(autocorrelation(values, 3)));
  EXPECT_TRUE(std::isnan(autocorrelation(std::vector<double>{4, 4, 4})));
}

// The pooled standard deviation within groups. A value x is off by |x| 2⁻⁵³ at most when it becomes binary64, so the
// standard deviation by √(n/(n − k)) of that: as many digits are in the data, less one for the certified 15th.
TEST(Moments, StandardDeviationsWithinGroupsOfNistReferenceData) {
  for (const nist::AnovaDataset& data : nist::kAnova) {
    double squares = 0, largest = 0;
    std::int64_t dof = 0, count = 0;
    for (const std::vector<double>& group : data.groups) {
      Moments moments;
      moments.add(group);
      squares += moments.central2;
      dof += moments.count - 1;
      count += moments.count;
      for (const double x : group) largest = std::max(largest, std::abs(x));
    }
    const double sd = std::sqrt(squares / static_cast<double>(dof));
    const double reach = std::sqrt(static_cast<double>(count) / static_cast<double>(dof)) * largest * 0x1p-53;
    EXPECT_GE(correct_digits(sd, data.residual_sd), std::min(14.0, -std::log10(reach / data.residual_sd))) << data.name;
  }
}

}  // namespace
}  // namespace halfslope
