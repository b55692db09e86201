#include "experiments/pilot.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "experiments/plan_references.h"
#include "scenes/function_source.h"
#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr int kSide = 40;

// Noise whose standard deviation is 1 in all pixels but a few, and 30 there: a 0.5 % of the pixels with 82 % of the
// squared error. The integral is 0, and not known.
double scale_of(int pixel) { return pixel % 199 == 5 ? 30 : 1; }

Catalogue catalogue_with(const std::string& name, FunctionSource::Function f) {
  Catalogue catalogue = Catalogue::built_in();
  catalogue.add_scene({name, "", "a function of the test", ""}, [=](const std::string&, const Catalogue::Resolution&) {
    return std::make_unique<FunctionSource>(name, 2, f, std::nullopt, kSide, kSide);
  });
  return catalogue;
}

Catalogue noise() {
  return catalogue_with(
      "noise", [](std::span<const double> x, int pixel) { return scale_of(pixel) * std::sqrt(12.0) * (x[0] - 0.5); });
}

Plan plan_of(const Catalogue& catalogue, std::map<std::string, std::string> keys) {
  return make_plan(spec_of(keys), catalogue);
}

double mean_square_scale() {
  double sum = 0;
  for (int p = 0; p < kSide * kSide; ++p) sum += scale_of(p) * scale_of(p);
  return sum / (kSide * kSide);
}

TEST(Pilot, TakesEachRandomisedPassAtItsLargestN) {
  const Catalogue catalogue = noise();
  const Plan plan =
      plan_of(catalogue, {{"scene", "noise"}, {"samplers", "independent,stratified"}, {"samples", "4:64"}});
  const Pilot pilot = plan_pilot(plan, 0, catalogue.samplers);
  EXPECT_EQ(pilot.pixels, 64u);
  ASSERT_THAT(pilot.passes, SizeIs(2));
  EXPECT_EQ(pilot.passes[0].samples, (std::vector<std::uint64_t>{4, 8, 16, 32, 64}));  // a sequence's come for nothing
  EXPECT_EQ(pilot.passes[1].samples, std::vector<std::uint64_t>{64});
  EXPECT_EQ(pilot.evaluations(), 2.0 * 64 * 64 * 16);
  EXPECT_THAT(pilot.left_out, IsEmpty());
}

TEST(Pilot, HaltonOwenStandsInForDeterministicSamplersOnce) {
  const Catalogue catalogue = noise();
  const auto pilot_of = [&](const char* samplers) {
    const Plan plan = plan_of(catalogue, {{"scene", "noise"}, {"samplers", samplers}, {"samples", "16:64"}});
    return plan_pilot(plan, 0, catalogue.samplers);
  };
  const Pilot two = pilot_of("halton,faure,independent");
  ASSERT_THAT(two.passes, SizeIs(2));
  EXPECT_EQ(two.passes[0].sampler, "halton-owen");
  EXPECT_EQ(two.passes[0].in_place_of, "halton");
  EXPECT_EQ(two.passes[1].sampler, "independent");
  const Pilot with = pilot_of("halton,halton-owen");
  ASSERT_THAT(with.passes, SizeIs(1));
  EXPECT_EQ(with.passes[0].in_place_of, "");
}

TEST(Pilot, PixelsAreAllOfFewAndWeightedAmongMany) {
  const Catalogue catalogue = noise();
  std::map<std::string, std::string> keys = {{"scene", "noise"}, {"samplers", "independent"}, {"samples", "4"}};
  const Plan all = plan_of(catalogue, keys);
  std::vector<double> sizes;
  for (int p = 0; p < kSide * kSide; ++p) sizes.push_back(scale_of(p) * scale_of(p));
  const auto pixels = choose_pilot_pixels(all.scenes[0], sizes);
  // x = π is estimated without error, since every pixel has the same x/π; hits are whole, so x = size nearly so.
  double by_probability = 0, heavy = 0;
  std::set<std::size_t> positions;
  for (const PilotPixel& pixel : pixels) {
    const double probability =
        0.5 / (kSide * kSide) + 0.5 * sizes[pixel.position] / (mean_square_scale() * kSide * kSide);
    by_probability += pixel.weight * probability * kSide * kSide;
    heavy += scale_of(static_cast<int>(pixel.position)) > 1 ? 1 : 0;
    positions.insert(pixel.position);
  }
  EXPECT_NEAR(by_probability, 1, 1e-9);
  EXPECT_EQ(heavy, 9);  // each of the few holds some 4.6 % of the sum, three steps of 1/64
  EXPECT_EQ(positions.size(), pixels.size());

  keys["pixels"] = "64";
  const Plan few = plan_of(catalogue, keys);
  const auto each = choose_pilot_pixels(few.scenes[0], std::vector<double>(64, 1.0));
  ASSERT_THAT(each, SizeIs(64));
  for (const PilotPixel& pixel : each) EXPECT_EQ(pixel.weight, 1.0 / 64);
}

// Over all pixels the mean squared error at N is mean(scale²)/N. That of 16 replicates of each of 9 heavy pixels, with
// kurtosis 3 − 1.2/N, has the relative standard error √((1.98/16) (heavy² share)/9) ≈ 10 %, and the light ones add
// less; 0.5 is five of them.
TEST(Pilot, FindsTheErrorThatFewPixelsHold) {
  const Catalogue catalogue = noise();
  const Plan plan = plan_of(catalogue, {{"scene", "noise"}, {"samplers", "independent"}, {"samples", "4:64"}});
  std::vector<double> variances;
  for (int p = 0; p < kSide * kSide; ++p) variances.push_back(scale_of(p) * scale_of(p));
  const Pilot pilot = plan_pilot(plan, 0, catalogue.samplers);
  const ExpectedError one = run_pilot(plan, 0, pilot, variances, catalogue.samplers, 1, true);
  EXPECT_EQ(one.cell, "mean,independent,f32,64");
  EXPECT_EQ(one.cells, 5u);
  EXPECT_EQ(one.without_error, 0u);
  EXPECT_NEAR(one.mse / (mean_square_scale() / 64), 1, 0.5);
  const ExpectedError three = run_pilot(plan, 0, pilot, variances, catalogue.samplers, 3, true);
  EXPECT_EQ(three.mse, one.mse);
  EXPECT_EQ(three.cell, one.cell);
}

TEST(Pilot, DependsOnNeitherSeedNorReplicates) {
  const Catalogue catalogue = noise();
  const auto expected = [&](const char* seed, const char* replicates) {
    const Plan plan = plan_of(catalogue, {{"scene", "noise"},
                                          {"samplers", "halton-owen"},
                                          {"samples", "16"},
                                          {"seed", seed},
                                          {"replicates", replicates}});
    return run_pilot(plan, 0, plan_pilot(plan, 0, catalogue.samplers), std::vector<double>(kSide * kSide, 1.0),
                     catalogue.samplers, 0, true);
  };
  EXPECT_EQ(expected("1", "16").mse, expected("2", "999").mse);
}

// Estimates that err by rounding alone have no say: no reference could be a hundred times better than rounding.
TEST(Pilot, CellsWithoutErrorHaveNoSay) {
  const Catalogue catalogue = catalogue_with("flat", [](std::span<const double> x, int) { return 0.1 + 1e-9 * x[0]; });
  const Plan plan = plan_of(catalogue, {{"scene", "flat"}, {"samplers", "independent"}, {"samples", "4:16"}});
  const ExpectedError expected = run_pilot(plan, 0, plan_pilot(plan, 0, catalogue.samplers),
                                           std::vector<double>(kSide * kSide, 0.0), catalogue.samplers, 0, true);
  EXPECT_EQ(expected.mse, 0);
  EXPECT_EQ(expected.cells, 3u);
  EXPECT_EQ(expected.without_error, 3u);
}

TEST(PlanReferences, TheShareIsAQuarterOfTheReplicatesOwnSpread) {
  const Catalogue catalogue = noise();
  const auto share = [&](const char* replicates) {
    return reference_share(
        plan_of(catalogue,
                {{"scene", "noise"}, {"samplers", "independent,halton"}, {"samples", "4"}, {"replicates", replicates}}),
        0);
  };
  EXPECT_EQ(share("1"), 0.01);
  EXPECT_EQ(share("625"), 0.01);
  EXPECT_DOUBLE_EQ(share("2500"), 0.005);
}

TEST(PlanReferences, AreDescribedAndNothingIsRendered) {
  const Catalogue catalogue = catalogue_with("never", [](std::span<const double>, int) -> double {
    ADD_FAILURE() << "the integrand is evaluated";
    return 0;
  });
  const Plan plan =
      plan_of(catalogue, {{"scene", "never,quarterdisk"}, {"samplers", "independent,halton"}, {"samples", "4:1024"}});
  const auto lines = describe_references(plan, catalogue.samplers);
  ASSERT_THAT(lines, SizeIs(1));
  EXPECT_THAT(lines[0],
              HasSubstr("never: 16 replicates of N = 4096 or more, until their variance is at most 1 % of the "
                        "smallest error of a pilot: 64 pixels x 16 replicates of 2 passes, 2.1e+06 integrand"));
  EXPECT_THAT(lines[0], HasSubstr("; halton-owen stands in for halton"));
}

// A run: the reference's variance is 1 % of every cell's measured error, or twice that, since the pilot's smallest of
// many estimates errs. What a deterministic sampler will do nobody can tell; it is not marked as limited by the
// reference.
TEST(PlanReferences, OfARunAreGoodEnoughForItsBestCell) {
  const RunScope scope;
  const auto outcome = scope.run({{"scene", "veach-mis"},
                                  {"resolution", "24,16"},
                                  {"samplers", "independent,halton-owen,halton"},
                                  {"samples", "16:256"},
                                  {"replicates", "16"}});
  for (const CellResult& cell : outcome.results.cells) {
    EXPECT_LE(cell.statistics.reference_mse, (cell.facts.deterministic ? 0.1 : 0.02) * cell.mse)
        << to_string(cell.name);
  }
}

}  // namespace
}  // namespace halfslope
