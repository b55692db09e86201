#include "experiments/plan.h"

#include <gmock/gmock.h>

#include <numeric>
#include <set>

#include "core/error.h"
#include "experiments/engine.h"
#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Plan plan_of(const std::map<std::string, std::string>& keys) { return make_plan(spec_of(keys), Catalogue::built_in()); }

TEST(Plan, EveryReplicateOfEveryPixelIsInOneUnitOfEachPass) {
  for (const auto& [samples, replicates] :
       {std::pair("4:16", "200"), {"16384", "64"}, {"1048576", "70"}, {"2", "9000"}}) {
    const Plan plan = plan_of({{"scene", "veach-mis,mis-toy"},
                               {"resolution", "30,20"},
                               {"samplers", "independent,n-rooks"},
                               {"samples", samples},
                               {"replicates", replicates}});
    std::vector<std::map<std::pair<std::size_t, std::int64_t>, int>> seen(plan.passes.size());
    double evaluations = 0;
    std::size_t number = 0;
    for (const Unit& unit : plan.units) {
      const Pass& pass = plan.passes[unit.pass];
      EXPECT_GE(number++, pass.first_unit);
      EXPECT_LE(unit.pixel_count, 256u);
      for (std::size_t p = 0; p < unit.pixel_count; ++p) {
        for (std::int64_t b = 0; b < unit.replicate_count; b += 1 + unit.replicate_count / 3)
          ++seen[unit.pass][{unit.first_pixel + p, unit.first_replicate + b}];
      }
      evaluations += static_cast<double>(pass.evaluations()) * static_cast<double>(unit.pixel_count) *
                     static_cast<double>(unit.replicate_count);
    }
    EXPECT_EQ(plan.evaluations(), evaluations);
    double expected = 0;
    for (std::size_t p = 0; p < plan.passes.size(); ++p) {
      const Pass& pass = plan.passes[p];
      const auto pixels = static_cast<double>(plan.scenes[pass.scene].pixels.size());
      EXPECT_EQ(pass.replicates, std::stoll(replicates));
      expected += static_cast<double>(pass.evaluations()) * pixels * static_cast<double>(pass.replicates);
      std::set<std::size_t> covered;
      for (const auto& [place, times] : seen[p]) {
        EXPECT_EQ(times, 1);
        covered.insert(place.first);
      }
      EXPECT_EQ(covered.size(), plan.scenes[pass.scene].pixels.size());
    }
    EXPECT_EQ(evaluations, expected);
  }
}

// A unit is a function of the experiment, small enough that little is lost with it: at most 2^24 evaluations, or 64
// replicates of one pixel.
TEST(Plan, UnitsAreSmall) {
  for (const char* samples : {"4:1024", "4096", "262144", "4194304"}) {
    const Plan plan = plan_of({{"scene", "veach-mis"},
                               {"resolution", "96,64"},
                               {"samplers", "independent,stratified"},
                               {"samples", samples},
                               {"replicates", "500"}});
    for (const Unit& unit : plan.units) {
      const auto each = plan.passes[unit.pass].evaluations();
      const auto work = each * unit.pixel_count * static_cast<std::uint64_t>(unit.replicate_count);
      EXPECT_LE(work, std::max<std::uint64_t>(1 << 24, each * 64));
    }
  }
}

TEST(Plan, HeuristicsShareAPassExactlyWhereTheirSamplesAreTheSame) {
  const Plan plan =
      plan_of({{"scene", "mis-toy"},
               {"estimators", "light,balance,power,power:3@light*3+bsdf,average@light*3+bsdf,balance@light"},
               {"samplers", "independent"},
               {"samples", "4,8"}});
  ASSERT_EQ(plan.passes.size(), 3u);
  EXPECT_THAT(plan.passes[0].estimators, ElementsAre(0, 5));  // balance@light is light
  EXPECT_THAT(plan.passes[1].estimators, ElementsAre(1, 2));
  EXPECT_THAT(plan.passes[2].estimators, ElementsAre(3, 4));
  EXPECT_THAT(plan.skips, Contains("mis-toy, independent, f32: balance, power share one pass over the same samples"));
  for (const Cell& cell : plan.cells) {
    const Pass& pass = plan.passes[cell.pass];
    EXPECT_EQ(pass.estimators[cell.heuristic], cell.estimator);
    EXPECT_EQ(pass.samples[cell.n], cell.samples);
  }
}

TEST(Plan, ASequenceTakesItsSmallerNFromPrefixes) {
  const Plan plan = plan_of(
      {{"scene", "quarterdisk"}, {"samplers", "halton-owen,n-rooks"}, {"samples", "4:64"}, {"replicates", "10"}});
  ASSERT_EQ(plan.passes.size(), 2u);
  EXPECT_EQ(plan.passes[0].evaluations(), 64u);
  EXPECT_EQ(plan.passes[1].evaluations(), 4u + 8 + 16 + 32 + 64);
  EXPECT_EQ(plan.evaluations(), 640 + 1240);
  EXPECT_THAT(plan.skips,
              Contains(HasSubstr("halton-owen, f32: a sequence, so N = 4 … 32 are prefixes of one pass to 64")));
  EXPECT_THAT(plan.skips, Not(Contains(HasSubstr("n-rooks, f32: a sequence"))));
}

// Each reason of --dry-run, from scenes that have it.
TEST(Plan, SaysWhatIsSkippedAndWhy) {
  const Plan veach =
      plan_of({{"scene", "veach-mis"}, {"samplers", "independent"}, {"samples", "4"}, {"resolution", "24,16"}});
  EXPECT_THAT(veach.skips, Contains(HasSubstr("veach-mis: ")));
  EXPECT_THAT(
      veach.skips,
      Contains(HasSubstr("of 384 pixels see only background, what does not reflect or what no light reaches: constant, "
                         "not sampled")));
  EXPECT_THAT(veach.skips, Contains(HasSubstr("nothing that could come between them and a light: no shadow rays")));
  EXPECT_THAT(veach.skips, Not(Contains(HasSubstr("one light"))));
  EXPECT_THAT(veach.skips, Not(Contains(HasSubstr("closed form"))));
  const Plan toy =
      plan_of({{"scene", "mis-toy"}, {"estimators", "balance"}, {"samplers", "independent"}, {"samples", "1:4"}});
  EXPECT_THAT(toy.skips, Contains("mis-toy: its integral is known in closed form: no reference is rendered"));
  EXPECT_THAT(toy.skips, Contains(HasSubstr("independent: N = 1 left out for balance: ")));
  ASSERT_EQ(toy.cells.size(), 2u);

  const TemporaryFolder folder;
  write_file_atomically(folder / "one.xml", R"(<scene version="3.0.0">
  <sensor type="radiancemeter"><point name="origin" x="0" y="0" z="1"/><vector name="direction" x="0" y="0" z="-1"/></sensor>
  <shape type="rectangle"/>
  <shape type="sphere"><point name="center" x="0" y="0" z="3"/><float name="radius" value="0.5"/>
    <emitter type="area"><rgb name="radiance" value="1"/></emitter></shape>
</scene>
)");
  const Plan one = plan_of({{"scene", (folder / "one.xml").string()}, {"samplers", "independent"}, {"samples", "4"}});
  EXPECT_THAT(one.skips, Contains(HasSubstr("one light: no light choice, and no dimension for it")));
  EXPECT_THAT(one.skips, Contains(HasSubstr("grey scene: one channel")));
  EXPECT_EQ(one.scenes[0].source->channels(), 1);
  const Layout& light = one.scenes[0].source->techniques()[0].layout;
  EXPECT_EQ(light.dims(), 2);  // three where a light is to be chosen
  EXPECT_EQ(veach.scenes[0].source->techniques()[0].layout.dims(), 3);
  std::set<std::string> unique(veach.skips.begin(), veach.skips.end());
  EXPECT_EQ(unique.size(), veach.skips.size());
}

// A choice of pixels: fixed, ascending, one in each of equal runs of the image.
TEST(Plan, ChosenPixelsAreSpreadOverTheImage) {
  for (const int count : {1, 7, 50, 599, 600, 1000}) {
    const std::map<std::string, std::string> keys = {
        {"scene", "veach-mis"}, {"resolution", "30,20"},           {"samplers", "independent"},
        {"samples", "4"},       {"pixels", std::to_string(count)}, {"images", "4"}};
    const Plan plan = plan_of(keys);
    const std::vector<int>& pixels = plan.scenes[0].pixels;
    const auto chosen = static_cast<std::size_t>(std::min(count, 600));
    ASSERT_EQ(pixels.size(), chosen);
    for (std::size_t i = 0; i < chosen; ++i) {
      EXPECT_GE(static_cast<std::size_t>(pixels[i]), i * 600 / chosen);
      EXPECT_LT(static_cast<std::size_t>(pixels[i]), (i + 1) * 600 / chosen);
    }
    auto other_seed = keys;
    other_seed["seed"] = "2";
    EXPECT_EQ(plan_of(other_seed).scenes[0].pixels, pixels);
    const bool whole = chosen == 600;
    EXPECT_EQ(plan.cells[0].image, whole);
    EXPECT_EQ(
        std::count(plan.skips.begin(), plan.skips.end(), "veach-mis: no images, since not all pixels are measured"),
        whole ? 0 : 1);
  }
}

TEST(Plan, EstimatorsDefaultToTheUsualOnes) {
  const Plan plan = plan_of({{"scene", "mis-toy,quarterdisk"}, {"samplers", "independent"}, {"samples", "4"}});
  std::vector<std::string> names;
  for (const Cell& cell : plan.cells) names.push_back(plan.scenes[cell.scene].estimators[cell.estimator].name);
  EXPECT_THAT(names, ElementsAre("light", "bsdf", "average", "balance", "power", "mean"));
}

TEST(Plan, OfSeveralScenesEachHasTheEstimatorsAndTheResolutionThatFitIt) {
  const Plan plan = plan_of({{"scene", "quarterdisk,veach-mis"},
                             {"estimators", "mean,surface,balance@light+cosine"},
                             {"resolution", "12,8"},
                             {"samplers", "independent"},
                             {"samples", "4"}});
  ASSERT_EQ(plan.cells.size(), 3u);
  EXPECT_EQ(plan.scenes[0].estimators.size(), 1u);
  EXPECT_EQ(plan.scenes[1].estimators.size(), 2u);
  EXPECT_EQ(plan.scenes[0].source->pixels(), 1);
  EXPECT_EQ(plan.scenes[1].source->width(), 12);
  EXPECT_THAT(plan.skips, Contains("quarterdisk: has mean to draw with; left out: surface, balance@light+cosine"));
  EXPECT_THAT(
      plan.skips,
      Contains("veach-mis: has light, bsdf, hemisphere, cosine, surface, light-power, light-bvh, light-solid-angle, "
               "light-power-solid-angle, light-bvh-solid-angle to draw with; left out: "
               "mean"));
  // What no scene takes is a mistake.
  try {
    plan_of({{"scene", "quarterdisk,veach-mis"},
             {"estimators", "mean,ballance"},
             {"samplers", "independent"},
             {"samples", "4"}});
    FAIL() << "an estimator that there is not";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    EXPECT_THAT(error.what(), HasSubstr("there is no estimator 'ballance' for this scene"));
  }
}

TEST(Plan, IsDescribedInLines) {
  const Spec spec = spec_of({{"name", "look"},
                             {"scene", "quarterdisk"},
                             {"samplers", "halton-owen"},
                             {"samples", "4:16"},
                             {"replicates", "8"}});
  const Catalogue catalogue = Catalogue::built_in();
  const Plan plan = make_plan(spec, catalogue);
  const std::string text = describe_plan(spec, plan, catalogue);
  EXPECT_THAT(text, HasSubstr("look: 3 cells from 1 pass in 1 unit of work, 128 integrand evaluations\n"));
  for (const auto& skip : plan.skips) EXPECT_THAT(text, HasSubstr("  " + skip + "\n"));
}

// N, the seed, the scene's own numbers and its resolution determine a run; its name does not.
TEST(Plan, PassesAreKeyedBySeedAndSampler) {
  std::map<std::string, std::string> keys = {
      {"scene", "mis-toy"}, {"samplers", "independent,n-rooks"}, {"samples", "4"}};
  const Plan a = plan_of(keys);
  keys["seed"] = "2";
  const Plan b = plan_of(keys);
  EXPECT_FALSE(a.passes[0].key == b.passes[0].key);
  std::set<std::pair<std::uint32_t, std::uint32_t>> keys_of_passes;
  std::set<std::string> samplers;
  for (const Pass& pass : a.passes) {
    keys_of_passes.insert({pass.key.word0, pass.key.word1});
    samplers.insert(pass.sampler);
  }
  EXPECT_EQ(keys_of_passes.size(), samplers.size());
  EXPECT_FALSE(a.passes[0].key == stream_key(0, "halton-owen", "reference"));
}

}  // namespace
}  // namespace halfslope
