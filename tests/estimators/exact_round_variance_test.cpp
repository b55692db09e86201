// Predicted variances against independent ones: quadrature with 30 digits, or closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "estimators/exact_variance.h"
#include "scenes/integrand.h"

namespace halfslope {
namespace {

double predicted(const std::string& scene, const std::string& estimator) {
  const auto source = make_analytic_scene(scene);
  return exact_round_cumulants(parse_estimator(estimator, source->techniques()), *source->exact_densities()).value()[2];
}

struct Known {
  const char* estimator;
  double variance;
};

// `negligible`: what a variance that should be 0 may come to.
void expect_known(const std::string& scene, const std::vector<Known>& known, double negligible) {
  for (const auto& [estimator, variance] : known) {
    EXPECT_NEAR(predicted(scene, estimator), variance, 1e-4 * variance + negligible) << scene << ' ' << estimator;
  }
}

TEST(ExactRoundVariance, ToyProblem) {
  expect_known("mis-toy",
               {{"light", 1.0 / 12},
                {"bsdf", 0},
                {"average", 1.0 / 48},
                {"balance", 0.011110988148968387},
                {"power", 0.013250220050248314},
                {"power:3", 0.020228413431753918},
                {"power:4", 0.027833444461787576},
                {"cutoff:0.1", 0.011121517198756346},
                {"cutoff:0.5", 0.013146226126042774},
                {"cutoff:0.8", 0.052308892485402825},
                {"maximum", 7.0 / 96},
                {"optimal", 0},
                {"one-sample-balance", std::log(3.0) / 4 - 0.25},
                // All to where its density is the larger: ∫ 2 x² over x < 1/2, ∫ x over the rest, less μ².
                {"one-sample-maximum", 1.0 / 12 + 3.0 / 8 - 0.25},
                // ¼ light: ∫ x²/(1/4 + 3x/2) = (1/6 − 1/36·(1 − ln(7)/6))·4, less μ².
                {"one-sample-balance@light+bsdf*3", 4 * (1.0 / 12 - 1.0 / 36 + std::log(7.0) / 216) - 0.25},
                {"average@light*4+bsdf", 1.0 / 192}},
               1e-15);
}

TEST(ExactRoundVariance, AlignedPhongCaps) {
  expect_known("aligned-phong-cap:n=10,alpha=0.01",
               {{"light", 6.2990381283560985e-15},
                {"bsdf", 0.0005495555958422792},
                {"average", 0.00013738889896214456},
                {"balance", 1.6597842493415332e-10},
                {"power", 6.349262517832386e-15},
                {"maximum", 6.2990381283560985e-15},
                {"one-sample-balance", 3.020114568101539e-07},
                {"one-sample-power", 3.0234340078851757e-07},
                {"optimal", 6.295576455579766e-15}},
               0);
  expect_known("aligned-phong-cap:n=10000,alpha=0.01",
               {{"light", 0.0032126942860631756},
                {"balance", 0.020615636319222422},
                {"power", 0.006386093641269864},
                {"cutoff:0.5", 0.003221461715283858},
                {"one-sample-balance", 0.06975855154192127},
                {"one-sample-power", 0.09304825028748535},
                {"optimal", 0.002283754795031826}},
               0);
  expect_known("aligned-phong-cap:n=10000,alpha=0.8",
               {{"light", 1515.6939270231392},
                {"bsdf", 0},
                {"average", 378.9234817557848},
                {"balance", 0.0026284731899244556},
                {"power", 0.00042291265907067207},
                {"maximum", 0.000493916216484684},
                {"cutoff:0.1", 0.0007919675082120872},
                {"one-sample-balance", 0.994715123702673},
                {"one-sample-power", 0.9987773379157294},
                {"optimal", 0}},
               1e-15);
}

TEST(ExactRoundVariance, ThereIsNoneOfProgressiveWeights) {
  const auto source = make_analytic_scene("mis-toy");
  const Estimator estimator = parse_estimator("optimal-progressive", source->techniques());
  EXPECT_FALSE(exact_round_cumulants(estimator, *source->exact_densities()));
}

}  // namespace
}  // namespace halfslope
