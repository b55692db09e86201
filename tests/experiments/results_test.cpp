#include "experiments/results.h"

#include <gmock/gmock.h>

#include <cmath>
#include <mutex>

#include "core/error.h"
#include "core/exr.h"
#include "experiments/interrupt.h"
#include "experiments/journal.h"
#include "experiments/unit.h"
#include "scenes/function_source.h"
#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

using ::testing::ElementsAre;

/// Two tiles of pixels in two regions, integrals of known value; no integral is noisy in region "calm".
class Halves final : public IntegralSource {
 public:
  int width() const override { return 300; }
  std::span<const Technique> techniques() const override { return inner_.techniques(); }
  PixelIntegral pixel(int index) const override {
    PixelIntegral pixel = inner_.pixel(index);
    pixel.constant = {static_cast<double>(index), 0, 0};
    if (index < 100) pixel.integral.reset();
    return pixel;
  }
  std::optional<Color> closed_form(int index) const override { return Color{index + (index < 100 ? 0 : 0.5), 0, 0}; }
  std::vector<std::string> regions() const override { return {"calm", "wild/near", "wild/far", "nowhere"}; }
  int region(int index) const override { return index < 100 ? 0 : index < 280 ? 1 : 2; }
  std::string fingerprint() const override { return "halves"; }

 private:
  FunctionSource inner_{"inner", 1,
                        [](std::span<const double> x, int pixel) { return pixel < 280 ? x[0] : 4 * x[0] - 1.5; }};
};

Catalogue with_halves() {
  auto catalogue = Catalogue::built_in();
  catalogue.add_scene({"halves", "", "", ""},
                      [](const std::string&, const Catalogue::Resolution&) { return std::make_unique<Halves>(); });
  return catalogue;
}

const std::map<std::string, std::string> kHalves = {
    {"scene", "halves"}, {"samplers", "independent"}, {"samples", "4,16"}, {"replicates", "64"}, {"precision", "f64"}};

TEST(Results, RegionsAreMeasuredApartAndJoined) {
  const RunScope scope;
  const RunOutcome outcome = scope.run(kHalves, "out", with_halves());
  for (std::size_t c = 0; c < 2; ++c) {
    const CellResult& cell = outcome.results.cells[c];
    std::vector<std::string> names;
    std::map<std::string, RegionResult> regions;
    for (const RegionResult& region : cell.regions) names.push_back(region.region), regions[region.region] = region;
    EXPECT_THAT(names, ElementsAre("all", "calm", "wild", "wild/near", "wild/far"));
    EXPECT_EQ(regions["all"].pixels, 300);
    EXPECT_EQ(regions["calm"].pixels, 100);
    EXPECT_EQ(regions["wild"].pixels, 200);
    EXPECT_EQ(regions["wild/far"].pixels, 20);
    EXPECT_DOUBLE_EQ(*regions["all"].rmse, *cell.statistics.rmse);
    EXPECT_DOUBLE_EQ(*regions["all"].relmse, *cell.statistics.relmse);
    // Var(x) = 1/12, so N = 4 and 16 have it divided by N; the far region's is 16 times that. An MSE over n pixels and
    // 64 replicates of nearly normal errors has the relative standard error √(2/64n); 5.5 of them: false alarm below
    // 1e-6.
    const double near = 1.0 / 12 / (c == 0 ? 4 : 16);
    const auto within = [&](const char* name, double exact) {
      const RegionResult& region = regions[name];
      const double share = 5.5 * std::sqrt(2 / 64.0 / static_cast<double>(region.pixels));
      EXPECT_NEAR(*region.rmse * *region.rmse, exact, share * exact) << name;
      EXPECT_LT(*region.rmse_lo, *region.rmse);
      EXPECT_GT(*region.rmse_hi, *region.rmse);
    };
    within("wild/near", near);
    within("wild/far", 16 * near);
    const auto squared = [&](const char* name) { return *regions[name].rmse * *regions[name].rmse; };
    EXPECT_NEAR(squared("wild"), (180 * squared("wild/near") + 20 * squared("wild/far")) / 200, 1e-12);
    EXPECT_NEAR(squared("all"), squared("wild") * 200 / 300, 1e-12);
    EXPECT_FALSE(regions["calm"].rmse_lo.has_value());
    EXPECT_FALSE(regions["calm"].relmse_lo.has_value());
  }
}

TEST(Results, EachCellIsVisitedOnceAndInOrder) {
  const RunScope scope;
  const Spec spec = spec_of(kHalves);
  const Catalogue catalogue = with_halves();
  scope.run(kHalves, "out", catalogue);
  const Plan plan = make_plan(spec, catalogue);
  const Reference reference =
      make_reference(*plan.scenes[0].source, "halves", plan.scenes[0].pixels, {}, {0, true, {}}, catalogue.samplers);
  // The journal that the run left behind.
  const std::string line = read_file(scope.path("out/journal"));
  const auto field = [&](const std::string& name) {
    const auto at = line.find("\"" + name + "\":\"") + name.size() + 4;
    return line.substr(at, line.find('"', at) - at);
  };
  const Journal journal(scope.path("out"), {field("spec"), field("version"), field("isa_class")}, false);
  ASSERT_EQ(journal.size(), plan.units.size());
  std::mutex mutex;
  std::vector<std::uint64_t> folded, ordered;
  const CellVisitor visitor = {[&](const Cell& cell, const FoldedCell& data) {
                                 const std::lock_guard lock(mutex);
                                 folded.push_back(cell.samples);
                                 EXPECT_EQ(data.data.integrals, 300);
                                 EXPECT_EQ(data.data.replicates, 64);
                               },
                               [&](const Cell& cell, const FoldedCell& data) {
                                 ordered.push_back(cell.samples);
                                 EXPECT_EQ(data.data.per_replicate.size(), 64u);
                               }};
  const Results results = collect_results(plan, std::span(&reference, 1), journal, catalogue.samplers, 2, visitor);
  EXPECT_THAT(folded, ::testing::UnorderedElementsAre(4, 16));
  EXPECT_THAT(ordered, ElementsAre(4, 16));
  ASSERT_EQ(results.rates.size(), 1u);
  EXPECT_EQ(results.rates[0].theory, -0.5);

  const InterruptGuard guard;
  ::raise(SIGINT);
  try {
    collect_results(plan, std::span(&reference, 1), journal, catalogue.samplers, 2, visitor);
    ADD_FAILURE() << "went on after an interrupt";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kInterrupted);
  }
}

TEST(Results, APartSurvivesItsStorage) {
  CellPart part;
  part.replicates = {{1, 2, 3, 4}, {5, 6, 7, 8}};
  part.regions = {3, 1};
  part.squared = {{1, 2}, {3, 4}, {5, 6}, {7, 8}};
  part.integrals.resize(3);
  for (Moments& m : part.integrals) m.add(0.25), m.add(4);
  part.spread = {9, 10, 11};
  part.abs_error.add(0.125);
  part.nonfinite = 12, part.first_bad_replicate = 13, part.first_bad_pixel = 14;
  const std::vector<CellPart> parts = {CellPart(), part, CellPart()};
  const auto bytes = encode_parts(parts);
  for (std::size_t i = 0; i < 3; ++i) {
    const CellPart back = decode_part(i, [&](std::uint64_t offset, std::uint64_t size) {
      const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(offset);
      return std::vector<std::byte>(begin, begin + static_cast<std::ptrdiff_t>(size));
    });
    std::vector<std::byte> before, after;
    parts[i].append_to(before);
    back.append_to(after);
    EXPECT_EQ(before, after);
    EXPECT_EQ(back.replicates.size(), i == 1 ? 2u : 0u);
    if (i == 1) {
      EXPECT_EQ(back.replicates[1].max_abs_error, 8);
      EXPECT_EQ(back.squared[3].relative, 8);
      EXPECT_EQ(back.integrals[2].mean, 2.125);
      EXPECT_EQ(back.abs_error.count(), 1u);
      EXPECT_EQ(back.first_bad_pixel, 14u);
    }
  }
}

// Moments over replicates of every integral, merged over tiles and batches, are what the pictures show.
TEST(Results, IntegralsComeInTheOrderOfPixels) {
  const RunScope scope;
  auto keys = kHalves;
  keys["images"] = "16";
  scope.run(keys, "out", with_halves());
  const ExrImage image = read_exr(scope.path("out/images/halves/f64/mean/independent/16.exr"));
  ASSERT_EQ(image.width, 300);
  for (const auto& channel : image.channels) {
    if (channel.name != "R") continue;
    for (std::size_t p = 0; p < 300; ++p) {
      const double exact = static_cast<double>(p) + (p < 100 ? 0 : 0.5);
      // σ/√(64 · 16) = 0.009, 4 times that in the last 20: 5.5 of them over 200 pixels, false alarm 1e-5 · fixed seed.
      EXPECT_NEAR(channel.values[p], exact, p < 100 ? 0 : p < 280 ? 0.06 : 0.24);
    }
  }
}

}  // namespace
}  // namespace halfslope
