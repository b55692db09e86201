#include "experiments/reference.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/intervals.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/random.h"
#include "estimators/pass_evaluator.h"
#include "experiments/images.h"
#include "scenes/function_source.h"
#include "tests/experiments/run_spec.h"
#include "tests/experiments/temporary_folder.h"

namespace halfslope {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<int> all_pixels(const IntegralSource& source) {
  std::vector<int> pixels;
  for (int p = 0; p < source.pixels(); ++p) pixels.push_back(p);
  return pixels;
}

Reference render(const IntegralSource& source, const ReferenceGoal& goal, const std::filesystem::path& cache = {},
                 int threads = 0) {
  return make_reference(source, "scene", all_pixels(source), goal, {threads, true, cache},
                        SamplerCatalogue::built_in());
}

std::string refusal(const IntegralSource& source, const ReferenceGoal& goal) {
  try {
    render(source, goal);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  ADD_FAILURE() << "the reference could be made";
  return "";
}

/// Allows a mean variance that is this share of that of one replicate, as the first 16 show it.
std::function<AllowedVariance(std::span<const double>)> share_of_first(double share) {
  return [share](std::span<const double> variances) {
    double sum = 0;
    for (const double v : variances) sum += v;
    return AllowedVariance{share * sum / static_cast<double>(variances.size()), "somebody"};
  };
}

/// A floor at z = 0 of albedo `rho` under a sphere of `radius` and radiance 7 at height 2, seen where the angle between
/// the floor's normal and the sphere's centre has the cosine 2/√(4 + x²), for x = 0, 1, 2.
std::string floor_under_a_sphere(double rho, double radius) {
  std::string rays, directions;
  for (const int x : {0, 1, 2}) {
    rays += (rays.empty() ? "" : ", ") + std::to_string(x) + ", 1, 1";
    directions += (directions.empty() ? "" : ", ") + std::string("0, -1, -1");
  }
  return R"(<scene version="3.0.0">
  <sensor type="mradiancemeter"><string name="origins" value=")" +
         rays + R"("/><string name="directions" value=")" + directions + R"("/></sensor>
  <shape type="rectangle"><transform name="to_world"><scale value="50"/></transform>
    <bsdf type="diffuse"><rgb name="reflectance" value=")" +
         std::to_string(rho) + R"("/></bsdf></shape>
  <shape type="sphere"><point name="center" x="0" y="0" z="2"/><float name="radius" value=")" +
         std::to_string(radius) +
         R"("/><emitter type="area"><rgb name="radiance" value="7"/></emitter></shape>
</scene>)";
}

/// A scene that keeps its closed form to itself.
class Secretive final : public IntegralSource {
 public:
  explicit Secretive(const IntegralSource& source) : source_(source) {}
  int width() const override { return source_.width(); }
  int height() const override { return source_.height(); }
  int channels() const override { return source_.channels(); }
  std::span<const Technique> techniques() const override { return source_.techniques(); }
  std::vector<int> reference_techniques() const override { return source_.reference_techniques(); }
  PixelIntegral pixel(int index) const override { return source_.pixel(index); }
  std::string fingerprint() const override { return source_.fingerprint(); }

 private:
  const IntegralSource& source_;
};

bool same(const Reference& a, const Reference& b) {
  return a.value == b.value && a.variance == b.variance && a.half_a == b.half_a && a.half_b == b.half_b &&
         a.mse_noise == b.mse_noise && a.relmse_noise == b.relmse_noise && a.mean == b.mean && a.mean_se == b.mean_se &&
         a.mean_variance == b.mean_variance && a.samples == b.samples && a.replicates == b.replicates &&
         a.origin == b.origin;
}

TEST(Reference, ClosedFormsAreExact) {
  const Catalogue catalogue = Catalogue::built_in();
  const auto exact = [&](const std::string& name) {
    const auto source = catalogue.make_scene(name, {});
    const Reference reference = render(*source, {});
    EXPECT_EQ(reference.origin, "closed form");
    EXPECT_EQ(reference.variance, std::vector<double>{0});
    EXPECT_EQ(reference.mean_se, 0);
    EXPECT_EQ(reference.mean_variance, 0);
    EXPECT_EQ(reference.mean, reference.value[0]);
    return reference.mean;
  };
  EXPECT_EQ(exact("quarterdisk"), 0.5);
  EXPECT_EQ(exact("mis-toy"), 0.5);
  EXPECT_DOUBLE_EQ(exact("quartergaussian"), 0.5577462853510337);  // π/4 · erf(1)²
  EXPECT_DOUBLE_EQ(exact("aligned-phong-cap:n=1,alpha=1"), 1 - std::cos(1.0) * std::cos(1.0));
  const FunctionSource many(
      "many", 2, [](std::span<const double>, int) { return 3.0; }, 3.0, 4, 2);
  EXPECT_EQ(render(many, {}).value, std::vector<double>(8, 3.0));
}

// L = (ρ/π) E, and a sphere of radiance L_e above the horizon gives E = π L_e (s/d)² cos θ, d the distance of its
// centre: here L = 7 ρ s² · 2 / (4 + x²)^(3/2).
TEST(Reference, ARenderedOneIsWithinItsErrorOfTheClosedForm) {
  const TemporaryFolder folder;
  write_file_atomically(folder / "floor.xml", floor_under_a_sphere(0.5, 0.25));
  const auto source = Catalogue::built_in().make_scene((folder / "floor.xml").string(), {});
  ASSERT_EQ(source->pixels(), 3);
  ASSERT_EQ(source->channels(), 1);
  const Reference known = render(*source, {});
  EXPECT_EQ(known.origin, "closed form");
  const Reference reference = render(Secretive(*source), {.samples = 4096, .relative_error = 1e-4});
  EXPECT_EQ(reference.samples, 4096u);
  // Each of three pixels fails with a probability of 3e-7.
  const double t = t_quantile(1 - 1.5e-7, static_cast<double>(reference.replicates - 1));
  double relative = 0;
  for (int x = 0; x < 3; ++x) {
    const double exact = 7 * 0.5 * 0.25 * 0.25 * 2 / std::pow(4 + x * x, 1.5);
    EXPECT_NEAR(known.value[static_cast<std::size_t>(x)] / exact, 1, 1e-14);
    const double se = std::sqrt(reference.variance[static_cast<std::size_t>(x)]);
    EXPECT_GT(se, 0);
    EXPECT_NEAR(reference.value[static_cast<std::size_t>(x)], exact, t * se);
    relative +=
        se * se / (reference.value[static_cast<std::size_t>(x)] * reference.value[static_cast<std::size_t>(x)]) / 3;
  }
  EXPECT_LE(std::sqrt(relative), 1e-4);
  EXPECT_NEAR(reference.mean, (reference.value[0] + reference.value[1] + reference.value[2]) / 3, 1e-15);
}

TEST(Reference, IsExtendedUntilTheGoalIsMetAndNoFurther) {
  const FunctionSource source("wave", 2, [](std::span<const double> x, int) { return std::sin(9 * x[0]) + x[1]; });
  ReferenceGoal goal = {.samples = 64};
  const Reference least = render(source, goal);
  EXPECT_EQ(least.replicates, 16);
  const double first = std::sqrt(least.variance[0]) / std::fabs(least.value[0]);
  goal.relative_error = first / 3;  // takes about nine times as many
  const Reference more = render(source, goal);
  const double error = std::sqrt(more.variance[0]) / std::fabs(more.value[0]);
  EXPECT_LE(error, goal.relative_error);
  EXPECT_GE(more.replicates, 64);
  EXPECT_LE(more.replicates, 512);
  // ∫ sin 9x + ∫ y = (1 − cos 9)/9 + 1/2; false alarm 1e-6.
  const double t = t_quantile(1 - 5e-7, static_cast<double>(more.replicates - 1));
  EXPECT_NEAR(more.value[0], (1 - std::cos(9.0)) / 9 + 0.5, t * std::sqrt(more.variance[0]));
}

TEST(Reference, TheMostVarianceIsAskedForOnceAndReached) {
  const FunctionSource source("wave", 2, [](std::span<const double> x, int) { return std::sin(9 * x[0]) + x[1]; });
  int asked = 0;
  double most = 0;
  ReferenceGoal goal = {.samples = 64};
  goal.allowed = [&](std::span<const double> variances) {
    ++asked;
    EXPECT_EQ(variances.size(), 1u);
    most = variances[0] / 3000;
    return AllowedVariance{most, "somebody"};
  };
  const Reference more = render(source, goal);
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(more.samples, 64u);
  EXPECT_GT(more.replicates, 256);
  EXPECT_LE(more.mean_variance, most);
  goal.most_samples = 4096;  // now it may grow, which asks no more
  const Reference grown = render(source, goal);
  EXPECT_EQ(asked, 2);
  EXPECT_GT(grown.samples, 64u);
  EXPECT_LE(grown.replicates, 256);
  EXPECT_LE(grown.mean_variance, most);
}

// Every key of a run is a key for some seed, since the hash of the seed is a bijection: references must be kept apart
// by more than their key. Here the run has the reference's own.
TEST(Reference, SharesNoPointsWithARunOfAnySeed) {
  constexpr int kPixels = 400;
  const auto first = [](std::span<const double> x, int) { return x[0]; };
  const FunctionSource source("first", 1, first, std::nullopt, 20, 20);
  const Reference reference = render(source, {.samples = 8});
  ASSERT_EQ(reference.replicates, 16);
  const StreamKey key = stream_key(0, "halton-owen", "reference");
  PassEvaluator<double> evaluator(SamplerCatalogue::built_in().make("halton-owen"), source.techniques(), {{0}, {1}},
                                  {{HeuristicKind::kSingle, 0}}, {8}, 1);
  // Correlation, over pixels, of the errors of the reference with those of a run's first 16 replicates.
  double products = 0, squares = 0, reference_squares = 0;
  for (int p = 0; p < kPixels; ++p) {
    const PixelIntegral pixel = source.pixel(p);
    evaluator.run(*pixel.integral, key, static_cast<std::uint32_t>(p), 0);
    double mean = 0;
    for (int l = 0; l < 16; ++l) mean += evaluator.estimates(0, 0, 0)[l] / 16;
    const double own = reference.value[static_cast<std::size_t>(p)] - 0.5;
    EXPECT_NE(mean - 0.5, own);
    products += (mean - 0.5) * own;
    squares += (mean - 0.5) * (mean - 0.5);
    reference_squares += own * own;
  }
  // Of independent errors √400 · correlation is about normal: below 5 in all but 6e-7.
  EXPECT_LT(std::fabs(products / std::sqrt(squares * reference_squares)), 5 / std::sqrt(400.0));
  // What a reference draws, the same evaluator draws from its first replicate on: so the numbers above are those of
  // another replicate, and no replicate of a run is as high.
  const PixelIntegral pixel = source.pixel(7);
  evaluator.run(*pixel.integral, key, 7, kFirstReferenceReplicate);
  double mean = 0;
  for (int l = 0; l < 16; ++l) mean += evaluator.estimates(0, 0, 0)[l] / 16;
  EXPECT_NEAR(mean, reference.value[7], 1e-15);
  Spec spec = spec_of({{"scene", "mis-toy"}, {"samplers", "halton-owen"}, {"samples", "4"}});
  apply_flag(spec, "replicates", std::to_string(kFirstReferenceReplicate));
  EXPECT_EQ(spec.replicates, std::int64_t{kFirstReferenceReplicate});
  EXPECT_THROW(apply_flag(spec, "replicates", std::to_string(std::int64_t{kFirstReferenceReplicate} + 1)), Error);
}

// Two halves, each of half the replicates: their mean is the value, and over pixels their difference has four times the
// variance of the value. 400 pixels give the ratio with a relative standard error of √(2/400 (1 + 1/15)) = 7.3 %; 0.37
// is five of them.
TEST(Reference, ItsHalvesAreIndependent) {
  const FunctionSource source(
      "many", 2, [](std::span<const double> x, int) { return std::exp(x[0] + 2 * x[1]); }, std::nullopt, 20, 20);
  for (const double share : {1.0, 1.0 / 40}) {
    const Reference reference = render(source, {.samples = 64, .allowed = share_of_first(share)});
    EXPECT_EQ(reference.replicates, share == 1 ? 16 : 64);
    double squares = 0, products = 0;
    for (std::size_t p = 0; p < 400; ++p) {
      const double exact = (std::exp(1.0) - 1) * (std::exp(2.0) - 1) / 2;
      EXPECT_NEAR((reference.half_a[p] + reference.half_b[p]) / 2, reference.value[p], 1e-14 * exact);
      squares += std::pow(reference.half_a[p] - reference.half_b[p], 2) / 400;
      products += (reference.half_a[p] - exact) * (reference.half_b[p] - exact) / 400;
    }
    EXPECT_NEAR(squares / (4 * reference.mean_variance), 1, 0.37);
    EXPECT_LT(std::fabs(products), 5 * 2 * reference.mean_variance / std::sqrt(400.0));
  }
}

TEST(Reference, ItsPictureHasItsHalvesAsLayers) {
  const FunctionSource source(
      "many", 2, [](std::span<const double> x, int) { return std::exp(x[0] + 2 * x[1]); }, std::nullopt, 4, 2);
  const Reference reference = render(source, {.samples = 16});
  const ExrImage image = reference_image(source, reference);
  const auto layer = [&](const std::string& name) {
    const auto found = std::ranges::find(image.channels, name, &ExrImage::Channel::name);
    EXPECT_NE(found, image.channels.end()) << name;
    return found->values;
  };
  EXPECT_EQ(image.channels.size(), 12u);
  for (const std::string c : {"R", "G", "B"}) {
    for (std::size_t p = 0; p < 8; ++p) {
      EXPECT_EQ(layer("half_a." + c)[p], static_cast<float>(reference.half_a[p]));
      EXPECT_EQ(layer("half_b." + c)[p], static_cast<float>(reference.half_b[p]));
      EXPECT_EQ(layer("variance." + c)[p], static_cast<float>(reference.variance[p]));
      EXPECT_EQ(layer(c)[p], static_cast<float>(reference.value[p]));
    }
  }
}

TEST(Reference, WhereItMayNGrowsBeforeTheReplicatesDo) {
  const FunctionSource source("wave", 2, [](std::span<const double> x, int) { return std::sin(9 * x[0]) + x[1]; });
  ReferenceGoal goal = {.samples = 64, .relative_error = 1e-4, .most_samples = 32768};
  const Reference grown = render(source, goal);
  EXPECT_GT(grown.samples, 64u);
  EXPECT_LE(grown.samples, 32768u);
  EXPECT_LE(grown.replicates, 256);
  EXPECT_LE(std::sqrt(grown.variance[0]) / std::fabs(grown.value[0]), 1e-4);
  const double t = t_quantile(1 - 5e-7, static_cast<double>(grown.replicates - 1));  // false alarm 1e-6
  EXPECT_NEAR(grown.value[0], (1 - std::cos(9.0)) / 9 + 0.5, t * std::sqrt(grown.variance[0]));
  goal.most_samples = 512;  // is not enough: replicates must do the rest
  goal.relative_error = 3e-5;
  const Reference limited = render(source, goal);
  EXPECT_EQ(limited.samples, 512u);
  EXPECT_GT(limited.replicates, 256);
}

TEST(Reference, TooFewReplicatesAreAnErrorThatSaysWhatToDo) {
  const FunctionSource source("wave", 2, [](std::span<const double> x, int) { return std::sin(9 * x[0]) + x[1]; });
  const std::string relative = refusal(source, {.samples = 64, .relative_error = 1e-3, .most_replicates = 64});
  EXPECT_THAT(relative,
              StartsWith("scene 'scene': after 64 replicates of N = 64 the reference's relative error is still "));
  EXPECT_THAT(relative, HasSubstr("0.001 was asked for: about "));
  EXPECT_THAT(relative, HasSubstr("64 are the most; give it more --samples or --max-replicates"));
  const std::string share = refusal(source, {.samples = 64, .allowed = share_of_first(1e-9), .most_replicates = 64});
  EXPECT_THAT(share, StartsWith("scene 'scene': after 16 replicates"));  // where it plainly cannot be, at once
  EXPECT_THAT(share, HasSubstr("times what the smallest error to be measured allows, that of somebody: about 1e+09 "));
  EXPECT_THAT(share, HasSubstr("measure smaller N, or leave that one out"));
  EXPECT_THAT(refusal(source, {.samples = std::uint64_t{1} << 40}), HasSubstr("a reference takes at most N = "));
}

TEST(Reference, ThreadsAndCachesChangeNothing) {
  const TemporaryFolder folder;
  const auto source = Catalogue::built_in().make_scene("veach-mis", std::array{20, 14});  // more than 256 pixels
  const ReferenceGoal goal = {.samples = 64, .allowed = share_of_first(1.0 / 40)};
  const Reference plain = render(*source, goal, {}, 1);
  EXPECT_GT(plain.replicates, 16);  // so that one is extended
  EXPECT_TRUE(same(render(*source, goal, {}, 3), plain));
  const auto cache = folder / "cache";
  EXPECT_TRUE(same(render(*source, goal, cache), plain));
  EXPECT_TRUE(same(render(*source, goal, cache), plain));
  // Any part of the cache may be missing.
  for (const auto& entry : std::filesystem::directory_iterator(cache)) {
    const std::string bytes = read_file(entry.path());
    std::filesystem::remove(entry.path());
    EXPECT_TRUE(same(render(*source, goal, cache), plain));
    EXPECT_EQ(read_file(entry.path()), bytes);  // and is made anew
  }
}

TEST(Reference, ADamagedCacheIsRenderedAgain) {
  const TemporaryFolder folder;
  const FunctionSource source("wave", 2, [](std::span<const double> x, int) { return std::sin(9 * x[0]) + x[1]; });
  const ReferenceGoal goal = {.samples = 64};
  const Reference plain = render(source, goal, folder.path());
  const auto file = std::filesystem::directory_iterator(folder.path())->path();
  const std::string bytes = read_file(file);
  for (std::size_t i = 0; i < bytes.size(); i += 1 + bytes.size() / 41) {
    std::string flipped = bytes;
    flipped[i] = static_cast<char>(flipped[i] ^ 16);
    for (const std::string& damaged : {flipped, bytes.substr(0, i), bytes.substr(i)}) {
      if (damaged == bytes) continue;
      write_file_atomically(file, damaged);
      EXPECT_TRUE(same(render(source, goal, folder.path()), plain)) << "byte " << i;
      EXPECT_EQ(read_file(file), bytes);
    }
  }
}

// What determines a reference is its key: of two scenes or goals that differ, neither gets the other's.
TEST(Reference, TheCacheKnowsItsScenesApart) {
  const TemporaryFolder folder;
  const auto value = [&](const char* fingerprint, double c, std::uint64_t samples) {
    const FunctionSource source(fingerprint, 1, [c](std::span<const double>, int) { return c; });
    return render(source, {.samples = samples}, folder.path()).value[0];
  };
  EXPECT_EQ(value("a", 1, 64), 1);
  EXPECT_EQ(value("b", 2, 64), 2);
  EXPECT_EQ(value("a", 3, 128), 3);
  EXPECT_EQ(value("a", 4, 64), 1);  // the cache's: the fingerprint promised that it is the same function
}

TEST(Reference, ItsStandardErrorsCover) {
  // 400 pixels that are the same integral with points of their own: the share of |error| < 2.131 se (95 % of Student's
  // t with 15 degrees) is 0.95 ± 0.011; 0.89 is 5.5 standard deviations below. (Means of few scrambled points are
  // nearly normal here.)
  const FunctionSource source(
      "many", 2, [](std::span<const double> x, int) { return std::exp(x[0] + 2 * x[1]); }, std::nullopt, 20, 20);
  const Reference reference = render(source, {.samples = 256});
  ASSERT_EQ(reference.replicates, 16);
  const double exact = (std::exp(1.0) - 1) * (std::exp(2.0) - 1) / 2;
  int covered = 0;
  double sum = 0;
  for (std::size_t p = 0; p < 400; ++p) {
    covered += std::fabs(reference.value[p] - exact) < 2.131 * std::sqrt(reference.variance[p]) ? 1 : 0;
    sum += reference.variance[p];
  }
  EXPECT_GT(covered, 0.89 * 400);
  EXPECT_DOUBLE_EQ(reference.mean_variance, sum / 400);
  EXPECT_NEAR(reference.mean, exact, 8.8 * reference.mean_se);  // t with 15 degrees: false alarm 3e-7
}

}  // namespace
}  // namespace halfslope
