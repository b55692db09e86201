// What a run reports, computed again from what it wrote: tables against pictures, replicates and points.
#include "experiments/engine.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "analysis/intervals.h"
#include "core/exr.h"
#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}
double sample_variance(const std::vector<double>& values) {
  double sum = 0;
  const double centre = mean(values);
  for (const double x : values) sum += (x - centre) * (x - centre);
  return sum / static_cast<double>(values.size() - 1);
}
double central_moment(const std::vector<double>& values, int k) {
  std::vector<double> powers;
  for (const double x : values) powers.push_back(std::pow(x - mean(values), k));
  return mean(powers);
}

/// One cell's column of replicates.csv, in the order of replicates.
std::vector<double> replicates_of(const CsvTable& replicates, const CsvTable::Row& cell, const std::string& column) {
  std::vector<double> values;
  for (std::size_t r = 0; r < replicates.size(); ++r) {
    if (std::equal(cell.begin(), cell.begin() + 5, replicates.row(r).begin())) {
      EXPECT_EQ(replicates.number(r, "replicate"), static_cast<double>(values.size()));
      values.push_back(replicates.number(r, column));
    }
  }
  return values;
}

std::vector<double> layer(const ExrImage& image, const std::string& name) {
  std::vector<double> values;
  for (const char channel : {'R', 'G', 'B'}) {
    for (const auto& c : image.channels) {
      if (c.name == (name.empty() ? "" : name + ".") + channel)
        values.insert(values.end(), c.values.begin(), c.values.end());
    }
  }
  EXPECT_EQ(values.size(), 3u * static_cast<std::size_t>(image.width * image.height)) << name;
  return values;
}

// |a − b| within a share of |b|.
::testing::AssertionResult near(double a, double b, double share) {
  if (std::fabs(a - b) <= share * std::fabs(b)) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << a << " is not " << b;
}

// Every column that the replicates determine, on a rendered scene with a rendered reference and on one in closed form.
TEST(Engine, TheColumnsFollowFromTheReplicates) {
  const RunScope scope;
  scope.run({{"scene", "veach-mis,aligned-phong-cap:n=10,alpha=0.5"},
             {"resolution", "12,8"},
             {"samplers", "independent,halton-owen"},
             {"samples", "4,16"},
             {"replicates", "21"},
             {"precision", "f32,f64"}});
  const CsvTable cells = scope.table("convergence.csv"), replicates = scope.table("replicates.csv");
  ASSERT_EQ(cells.size(), 2u * 2 * 5 * 2 * 2);
  EXPECT_EQ(replicates.size(), cells.size() * 21);
  for (std::size_t r = 0; r < cells.size(); ++r) {
    const auto values = replicates_of(replicates, cells.row(r), "mean"),
               mse = replicates_of(replicates, cells.row(r), "mse"),
               mae = replicates_of(replicates, cells.row(r), "mae"),
               largest = replicates_of(replicates, cells.row(r), "max_abs_error");
    ASSERT_EQ(values.size(), 21u);
    EXPECT_EQ(cells.text(r, "replicates"), "21");
    EXPECT_TRUE(near(cells.number(r, "mean"), mean(values), 1e-12));
    EXPECT_TRUE(near(cells.number(r, "mae"), mean(mae), 1e-12));
    const double rmse = cells.number(r, "rmse"), v = cells.number(r, "reference_mse");
    EXPECT_TRUE(near(rmse * rmse + v, mean(mse), 1e-12));
    if (std::ranges::count(mse, mse[0]) < 21) {
      EXPECT_LT(cells.number(r, "rmse_lo"), rmse);
      if (cells.text(r, "rmse_hi").empty()) {  // beyond a million times the rmse: of rare large errors alone
        EXPECT_THAT(cells.text(r, "status"), HasSubstr("heavy-tailed"));
      } else {
        EXPECT_GT(cells.number(r, "rmse_hi"), rmse);
        EXPECT_LE(cells.number(r, "rmse_hi"), 1e6 * rmse);
      }
    } else {  // the cap's bsdf technique only counts hits, and a few good points hit equally often every time
      EXPECT_THAT(cells.text(r, "rmse_lo") + cells.text(r, "rmse_hi"), IsEmpty());
      EXPECT_EQ(cells.text(r, "estimator"), "bsdf");
    }
    // ē_i and the mean of replicate i differ by the reference's mean only.
    const double reference_se = cells.number(r, "reference_se");
    EXPECT_NEAR(cells.number(r, "bias"), mean(values) - cells.number(r, "reference"), 1e-12);
    EXPECT_TRUE(
        near(cells.number(r, "bias_se"), std::hypot(std::sqrt(sample_variance(values) / 21), reference_se), 1e-9));
    const bool exact = cells.text(r, "scene") != "veach-mis";
    EXPECT_EQ(reference_se == 0, exact);
    EXPECT_EQ(v == 0, exact);
    for (std::size_t k = 0; k < 21; ++k) {
      EXPECT_GE(mse[k], mae[k] * mae[k] * (1 - 1e-12));  // Jensen
      EXPECT_GE(largest[k], mae[k] * (1 - 1e-12));
      EXPECT_LE(mse[k], largest[k] * largest[k] * (1 + 1e-12));
    }
    if (!exact) continue;  // one integral: more is known
    EXPECT_EQ(cells.text(r, "pixels"), "1");
    EXPECT_TRUE(near(cells.number(r, "variance"), sample_variance(values), 1e-9));
    if (const double m2 = central_moment(values, 2); std::ranges::count(values, values[0]) < 21) {
      EXPECT_TRUE(near(cells.number(r, "kurtosis"), central_moment(values, 4) / (m2 * m2), 1e-9));
    }
    EXPECT_EQ(mae, largest);
    auto errors = mae;
    std::sort(errors.begin(), errors.end());
    EXPECT_TRUE(near(cells.number(r, "median_abs_error"), errors[10], 0.0055));  // half a bin of 64 an octave
    const double truth = cells.number(r, "reference");
    EXPECT_TRUE(near(cells.number(r, "relmse"), mean(mse) / (truth * truth + 0.01), 1e-12));
  }
}

// M = (R − 1)/R · variance + mean_p(ē_p²), and what else the pictures say of the table.
TEST(Engine, ThePicturesAndTheTableAgree) {
  const RunScope scope;
  scope.run({{"scene", "veach-mis"},
             {"resolution", "24,16"},
             {"estimators", "light,balance"},
             {"samplers", "stratified"},
             {"samples", "16"},
             {"images", "16"},
             {"replicates", "20"}});
  const CsvTable cells = scope.table("convergence.csv"), replicates = scope.table("replicates.csv");
  ASSERT_EQ(cells.size(), 2u);
  const ExrImage reference = read_exr(scope.path("out/reference.exr"));
  const auto truth = layer(reference, ""), doubt = layer(reference, "variance");
  EXPECT_EQ(reference.width, 24);
  for (std::size_t r = 0; r < cells.size(); ++r) {
    const ExrImage image =
        read_exr(scope.path(("out/images/veach-mis/f32/" + cells.text(r, "estimator") + "/stratified/16.exr").c_str()));
    EXPECT_EQ(image.channels.size(), 12u);
    const auto colour = layer(image, ""), variance = layer(image, "variance"), mse = layer(image, "mse"),
               bias = layer(image, "bias");
    std::vector<double> squared_bias, relative;
    for (std::size_t i = 0; i < bias.size(); ++i) {
      squared_bias.push_back(bias[i] * bias[i]);
      relative.push_back((mse[i] - doubt[i]) / (truth[i] * truth[i] + 0.01));
      EXPECT_NEAR(bias[i], colour[i] - truth[i], 2e-7 * (std::fabs(colour[i]) + std::fabs(truth[i])));
      EXPECT_TRUE(near(mse[i], 19.0 / 20 * variance[i] + bias[i] * bias[i], 1e-6));
    }
    // Pixels are binary32, so their means are good to 6e-8 of the mean magnitude.
    EXPECT_TRUE(near(mean(colour), cells.number(r, "mean"), 1e-7));
    EXPECT_TRUE(near(mean(truth), cells.number(r, "reference"), 1e-7));
    EXPECT_TRUE(near(mean(doubt), cells.number(r, "reference_mse"), 1e-7));
    EXPECT_TRUE(near(mean(variance), cells.number(r, "variance"), 1e-7));
    EXPECT_TRUE(near(mean(relative), cells.number(r, "relmse"), 1e-6));
    EXPECT_NEAR(mean(bias), cells.number(r, "bias"), 1e-7 * mean(colour));
    const double m = mean(replicates_of(replicates, cells.row(r), "mse"));
    EXPECT_TRUE(near(m, mean(mse), 1e-7));
    EXPECT_TRUE(near(m, 19.0 / 20 * cells.number(r, "variance") + mean(squared_bias), 1e-6));
  }
}

// The parts of a picture, weighted by their pixels, are the whole.
TEST(Engine, RegionsJoinToTheWhole) {
  const RunScope scope;
  scope.run({{"scene", "veach-mis"},
             {"resolution", "24,16"},
             {"estimators", "balance"},
             {"samplers", "independent"},
             {"samples", "4"},
             {"replicates", "20"}});
  const CsvTable cells = scope.table("convergence.csv"), regions = scope.table("regions.csv");
  double pixels = 0, mse = 0, leaf_pixels = 0, leaf_mse = 0;
  std::set<std::string> names;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const std::string name = regions.text(r, "region");
    EXPECT_TRUE(names.insert(name).second) << name << " stands there twice";
    if (regions.text(r, "rmse").empty()) continue;
    const double n = regions.number(r, "pixels"), rmse = regions.number(r, "rmse");
    if (name == "all") {
      EXPECT_EQ(n, 384);
      EXPECT_TRUE(near(rmse, cells.number(0, "rmse"), 1e-12));
      EXPECT_TRUE(near(regions.number(r, "relmse"), cells.number(0, "relmse"), 1e-12));
    } else if (name.find('/') == std::string::npos) {
      pixels += n, mse += n * rmse * rmse;
    } else {
      leaf_pixels += n, leaf_mse += n * rmse * rmse;
    }
  }
  for (const char* name : {"plate1", "plate2", "plate3", "plate4", "floor", "wall"}) EXPECT_TRUE(names.contains(name));
  const double total = 384 * cells.number(0, "rmse") * cells.number(0, "rmse");
  EXPECT_LE(pixels, 384);  // constant pixels have no error, and an exact part no interval
  EXPECT_TRUE(near(mse, total, 1e-9));
  EXPECT_TRUE(near(leaf_mse, total, 1e-9));
}

// 6000 replicates lie in several units, and their own rows are not kept. The estimates are made again here, from the
// sampler's points and the formula of the quarter disk.
TEST(Engine, ManyReplicatesAreMergedAsIfTheyWereOneBatch) {
  constexpr int kReplicates = 6000;
  const RunScope scope;
  const RunOutcome outcome = scope.run({{"scene", "quarterdisk"},
                                        {"samplers", "independent,n-rooks"},
                                        {"samples", "8,32"},
                                        {"replicates", std::to_string(kReplicates)},
                                        {"seed", "5"},
                                        {"precision", "f64"}});
  ASSERT_GT(outcome.plan.passes[0].batches(), 1u);
  const CsvTable cells = scope.table("convergence.csv"), rates = scope.table("rates.csv");
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_EQ(scope.table("replicates.csv").size(), 0u);
  for (std::size_t r = 0; r < cells.size(); ++r) {
    const std::string name = cells.text(r, "sampler");
    const auto n = static_cast<int>(cells.number(r, "samples"));
    const auto sampler = SamplerCatalogue::built_in().make(name);
    const Layout pair = {{2}};
    std::vector<double> estimates, errors, squares;
    PointBlock block;
    for (std::uint32_t first = 0; first < kReplicates; first += kLanes) {
      sampler->prepare({static_cast<std::uint64_t>(n), &pair, stream_key(5, name, "run"), 0, first, true});
      block.reset(2, n, true);
      sampler->fill(0, block);
      for (int lane = 0; lane < kLanes && estimates.size() < kReplicates; ++lane) {
        int inside = 0;
        for (int s = 0; s < n; ++s) {
          const double x = block.coordinate(0, s, lane), y = block.coordinate(1, s, lane);
          inside += x * x + y * y < 2 / std::numbers::pi ? 1 : 0;
        }
        estimates.push_back(static_cast<double>(inside) / n);
        errors.push_back(std::fabs(estimates.back() - 0.5));
        squares.push_back(errors.back() * errors.back());
      }
    }
    EXPECT_TRUE(near(cells.number(r, "mean"), mean(estimates), 1e-12));
    EXPECT_TRUE(near(cells.number(r, "variance"), sample_variance(estimates), 1e-9));
    EXPECT_TRUE(near(cells.number(r, "kurtosis"),
                     central_moment(estimates, 4) / std::pow(central_moment(estimates, 2), 2), 1e-9));
    EXPECT_TRUE(near(cells.number(r, "mae"), mean(errors), 1e-12));
    EXPECT_TRUE(near(cells.number(r, "bias"), mean(estimates) - 0.5, 1e-9));
    EXPECT_TRUE(near(cells.number(r, "bias_se"), std::sqrt(sample_variance(estimates) / kReplicates), 1e-9));
    const double m = mean(squares), rmse = cells.number(r, "rmse");
    EXPECT_TRUE(near(rmse, std::sqrt(m), 1e-12));
    EXPECT_TRUE(near(cells.number(r, "relmse"), m / 0.26, 1e-12));
    std::sort(errors.begin(), errors.end());
    const double median = errors[kReplicates / 2 - 1];
    EXPECT_NEAR(cells.number(r, "median_abs_error"), median, 0.0055 * median);
    // Student's t on log MSE: symmetric about it, with se(M)/M. 1.960359 is the 0.975 quantile with 5999 degrees.
    const double half_width = 1.960359 * std::sqrt(sample_variance(squares) / kReplicates) / m;
    EXPECT_NEAR(std::log(cells.number(r, "rmse_hi") / rmse), half_width / 2, 1e-6 * half_width);
    EXPECT_NEAR(std::log(rmse / cells.number(r, "rmse_lo")), half_width / 2, 1e-6 * half_width);
    EXPECT_EQ(cells.text(r, "status"), "ok");
  }
  for (std::size_t r = 0; r < rates.size(); ++r) {
    EXPECT_EQ(rates.text(r, "status"), "many-replicates");
    EXPECT_THAT(rates.text(r, "rate_lo"), IsEmpty());
    EXPECT_TRUE(near(rates.number(r, "rate"),
                     std::log(cells.number(2 * r + 1, "rmse") / cells.number(2 * r, "rmse")) / std::log(4), 1e-9));
  }
}

// rates.csv: the least-squares slope of the printed log rmse on log N.
TEST(Engine, RatesAreSlopesOfThePrintedErrors) {
  const RunScope scope;
  scope.run({{"scene", "quartergaussian"},
             {"samplers", "independent,n-rooks,halton-owen"},
             {"samples", "2,4,8,32,128,512"},
             {"replicates", "32"},
             {"precision", "f64"},
             {"seed", "3"}});
  const CsvTable cells = scope.table("convergence.csv"), rates = scope.table("rates.csv");
  ASSERT_EQ(rates.size(), 3u);
  ASSERT_EQ(cells.size(), 18u);
  for (std::size_t line = 0; line < 3; ++line) {
    std::vector<double> x, y;
    std::string status = "ok";
    for (std::size_t j = 0; j < 6; ++j) {
      x.push_back(std::log(cells.number(6 * line + j, "samples")));
      y.push_back(std::log(cells.number(6 * line + j, "rmse")));
      if (cells.text(6 * line + j, "status") != "ok") status = cells.text(6 * line + j, "status");
    }
    double sxy = 0, sxx = 0;
    for (std::size_t j = 0; j < 6; ++j) sxy += (x[j] - mean(x)) * y[j], sxx += (x[j] - mean(x)) * (x[j] - mean(x));
    EXPECT_TRUE(near(rates.number(line, "rate"), sxy / sxx, 1e-9));
    EXPECT_LT(rates.number(line, "rate_lo"), sxy / sxx);
    EXPECT_GT(rates.number(line, "rate_hi"), sxy / sxx);
    EXPECT_EQ(rates.text(line, "samples_lo"), "2");
    EXPECT_EQ(rates.text(line, "samples_hi"), "512");
    EXPECT_EQ(rates.text(line, "status"), status);  // a heavy tail at one N is a mark of the line
  }
  EXPECT_EQ(rates.text(0, "theory"), "-0.5");
}

// binary32 points are the top bits of the binary64 ones, so both precisions see the same error but for rounding.
TEST(Engine, PrecisionsSeeTheSamePoints) {
  const RunScope scope;
  scope.run({{"scene", "aligned-phong-cap:n=10,alpha=0.5,veach-mis"},
             {"resolution", "6,4"},
             {"samplers", "independent,stratified,n-rooks,halton-owen"},
             {"samples", "16"},
             {"replicates", "16"},
             {"precision", "f32,f64"}});
  const CsvTable cells = scope.table("convergence.csv");
  int compared = 0;
  for (std::size_t r = 0; r < cells.size(); ++r) {
    if (cells.text(r, "precision") != "f32") continue;
    const std::size_t other = r + 20;  // 5 estimators × 4 samplers
    ASSERT_EQ(cells.text(other, "precision"), "f64");
    ASSERT_EQ(cells.text(other, "sampler"), cells.text(r, "sampler"));
    EXPECT_TRUE(near(cells.number(r, "mean"), cells.number(other, "mean"), 1e-3));
    EXPECT_TRUE(near(cells.number(r, "rmse"), cells.number(other, "rmse"), 1e-2));
    if (cells.text(r, "scene") == "veach-mis") {
      EXPECT_NE(cells.text(r, "mean"), cells.text(other, "mean"));
    }
    ++compared;
  }
  EXPECT_EQ(compared, 40);
}

}  // namespace
}  // namespace halfslope
