// Environment maps: where Mitsuba's conventions put each pixel, radiance bilinear between them, densities that
// integrate to 1 and are those drawn with (chi-squared), with and without compensation, and maps that are refused.
#include "scenes/environment_map.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "scenes/emitters.h"
#include "tests/scenes/chi_squared.h"

namespace halfslope {
namespace {

constexpr double kPi = std::numbers::pi;

/// Pixels of very different brightness, some black; one patch is all black.
std::shared_ptr<Bitmap> bitmap(int width, int height, std::uint64_t seed = 1) {
  auto map = std::make_shared<Bitmap>();
  map->width = width, map->height = height, map->file = "sky.exr";
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const bool black = (i >= 1 && i <= 3 && j >= 1 && j <= 3) || unit(random) < 0.2;
      for (int c = 0; c < 3; ++c) map->rgb.push_back(black ? 0.f : static_cast<float>(std::exp(6 * unit(random) - 3)));
    }
  }
  return map;
}

Environment environment_of(std::shared_ptr<const Bitmap> map, bool compensation = false) {
  Environment environment;
  environment.map = std::move(map);
  environment.mis_compensation = compensation;
  environment.scale = 1.5;
  environment.from_world =
      (Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()) * Eigen::AngleAxisd(2, Vec3::UnitY())).toRotationMatrix();
  return environment;
}

/// The map's direction at `turns` of azimuth and polar angle θ, in world space.
Vec3 direction_at(const Environment& environment, double turns, double theta) {
  const double phi = 2 * kPi * turns;
  return environment.from_world.transpose() *
         Vec3(std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta));
}

template <class T>
Vec<T> as(const Vec3& v) {
  return {static_cast<T>(v.x()), static_cast<T>(v.y()), static_cast<T>(v.z())};
}

/// Column and row between pixels where a direction falls, by the convention that emitters.h states.
std::array<double, 2> grid_place(const Environment& environment, const Vec3& d) {
  const Vec3 l = environment.from_world * d;
  const double turns = std::atan2(l.x(), -l.z()) / (2 * kPi);
  const double x = turns * environment.map->width - 0.5;
  return {x < 0 ? x + environment.map->width : x, std::acos(l.y() / l.norm()) / kPi * (environment.map->height - 1)};
}

Rgb bilinear(const Environment& environment, const Vec3& d) {
  const Bitmap& map = *environment.map;
  const auto [x, y] = grid_place(environment, d);
  const int i = static_cast<int>(x), j = std::min(static_cast<int>(y), map.height - 2);
  const auto pixel = [&](int column, int row) {
    const float* p = map.rgb.data() + 3 * (row * map.width + column % map.width);
    return Rgb(double{p[0]}, double{p[1]}, double{p[2]});
  };
  const double a = x - i, b = y - j;
  return environment.scale * ((1 - b) * ((1 - a) * pixel(i, j) + a * pixel(i + 1, j)) +
                              b * ((1 - a) * pixel(i, j + 1) + a * pixel(i + 1, j + 1)));
}

double luminance(const Rgb& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

/// f, linear in the azimuth, averaged over a cell's solid angle by midpoints of the angles.
template <class Function>
double cell_mean(const Environment& environment, int column, int row, const Function& f, int points = 200) {
  const double step = kPi / (environment.map->height - 1);
  double sum = 0, weights = 0;
  for (int b = 0; b < points; ++b) {
    const double theta = (row + (b + 0.5) / points) * step;
    for (const double along : {0.25, 0.75}) {
      sum += std::sin(theta) * f(direction_at(environment, (column + 0.5 + along) / environment.map->width, theta));
      weights += std::sin(theta);
    }
  }
  return sum / weights;
}
double cell_solid_angle(const Environment& environment, int row) {
  const double step = kPi / (environment.map->height - 1);
  return 2 * kPi / environment.map->width * (std::cos(row * step) - std::cos((row + 1) * step));
}

TEST(Environment, MeanRadianceIsThatOfTheInterpolatedMap) {
  const Environment environment = environment_of(bitmap(9, 6));
  const EnvironmentMap<double> map(environment);
  constexpr int kAcross = 9 * 40, kDown = 5 * 200;  // midpoints that no kink divides
  Rgb sum = Rgb::Zero();
  for (int j = 0; j < kDown; ++j) {
    const double theta = kPi * (j + 0.5) / kDown;
    for (int i = 0; i < kAcross; ++i) {
      const Vec3 d = direction_at(environment, (i + 0.5) / kAcross, theta);
      double radiance[3];
      environment_radiance(map.data(), Vec<double>{d.x(), d.y(), d.z()}, radiance);
      sum += std::sin(theta) * Rgb(radiance[0], radiance[1], radiance[2]);
    }
  }
  const Rgb expected = sum * kPi / (2 * kDown) / kAcross, found = mean_radiance(environment);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / expected[c], 1, 1e-5);
}

template <class T>
class EnvironmentMapOf : public testing::Test {};
using Numbers = testing::Types<float, double>;
TYPED_TEST_SUITE(EnvironmentMapOf, Numbers);

// What a scene's author sees: without a rotation u = ½, the middle of the image, is +z, u = ¼ is +x, u = 0 is −z, and
// the top row is +y.
TYPED_TEST(EnvironmentMapOf, PixelsLieWhereMitsubaHasThem) {
  using T = TypeParam;
  auto map = std::make_shared<Bitmap>();
  map->width = 8, map->height = 5;
  for (int k = 0; k < 8 * 5; ++k) {
    for (int c = 0; c < 3; ++c) map->rgb.push_back(static_cast<float>(k + 100 * c));
  }
  Environment environment;
  environment.map = map;
  const EnvironmentMap<T> table(environment);
  const auto red = [&](Vec3 d) {
    T rgb[3];
    environment_radiance(table.data(), as<T>(d), rgb);
    EXPECT_NEAR(rgb[1], rgb[0] + 100, 1e-3);
    EXPECT_NEAR(rgb[2], rgb[0] + 200, 1e-3);
    return static_cast<double>(rgb[0]);
  };
  // Row 2 of 5 is the horizon; between the columns 1 and 2 lies u = ¼, between 3 and 4 u = ½, between 7 and 0 u = 0.
  EXPECT_NEAR(red({1, 0, 0}), 2 * 8 + 1.5, 1e-4);
  EXPECT_NEAR(red({0, 0, 1}), 2 * 8 + 3.5, 1e-4);
  EXPECT_NEAR(red({-1, 0, 0}), 2 * 8 + 5.5, 1e-4);
  EXPECT_NEAR(red({0, 0, -1}), 2 * 8 + 3.5, 1e-4);         // the mean of columns 7 and 0
  const double turn = 2 * kPi * 2.5 / 8, theta = kPi / 4;  // on the pixel in column 2 of row 1
  EXPECT_NEAR(red({std::sin(turn) * std::sin(theta), std::cos(theta), -std::cos(turn) * std::sin(theta)}), 10, 1e-4);
  EXPECT_LT(red({0, 1, 0}), 8);  // the top row
  EXPECT_GT(red({0, -1, 0}), 4 * 8 - 1e-3);
}

TYPED_TEST(EnvironmentMapOf, RadianceIsBilinearBetweenPixels) {
  using T = TypeParam;
  const Environment environment = environment_of(bitmap(13, 9));
  const EnvironmentMap<T> table(environment);
  std::mt19937_64 random(3);
  for (int k = 0; k < 5000; ++k) {
    const Vec3 d = random_direction(random);
    T rgb[3];
    environment_radiance(table.data(), as<T>(d), rgb);
    const Rgb exact = bilinear(environment, d);
    // Neighbours differ by up to 30; places in a cell have a few roundings of the whole grid's.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], exact[c], 30 * 13 * 16 * std::numeric_limits<T>::epsilon());
  }
}

TYPED_TEST(EnvironmentMapOf, DensityIsOneNumberACellAndIntegratesToOne) {
  using T = TypeParam;
  for (const bool compensation : {false, true}) {
    const Environment environment = environment_of(bitmap(13, 9), compensation);
    const EnvironmentMap<T> table(environment);
    double integral = 0, total = 0;
    std::vector<double> mean_luminance;
    for (int j = 0; j < 8; ++j) {
      for (int i = 0; i < 13; ++i) {
        mean_luminance.push_back(
            cell_mean(environment, i, j, [&](const Vec3& d) { return luminance(bilinear(environment, d)); }));
        total += mean_luminance.back() * cell_solid_angle(environment, j);
      }
    }
    EXPECT_NEAR(table.luminance_integral() / total, 1, 1e-5);  // midpoints' error
    double left = 0;
    for (std::size_t k = 0; k < mean_luminance.size(); ++k) {
      double& l = mean_luminance[k];
      if (compensation) l = std::max(0.0, l - total / (4 * kPi));
      left += l * cell_solid_angle(environment, static_cast<int>(k) / 13);
    }
    for (int j = 0; j < 8; ++j) {
      for (int i = 0; i < 13; ++i) {
        const T at_middle =
            environment_pdf(table.data(), as<T>(direction_at(environment, (i + 1.0) / 13, (j + 0.5) * kPi / 8)));
        integral += double{at_middle} * cell_solid_angle(environment, j);
        const double exact = mean_luminance[static_cast<std::size_t>(j * 13 + i)] / left;
        EXPECT_NEAR(at_middle, exact, 1e-5 * total / left * exact + 1e-5 / (4 * kPi)) << i << ' ' << j;
        cell_mean(
            environment, i, j,
            [&](const Vec3& d) {
              EXPECT_EQ(environment_pdf(table.data(), as<T>(d)), at_middle);
              return 0.0;
            },
            4);
      }
    }
    EXPECT_NEAR(integral, 1, 8 * std::numeric_limits<T>::epsilon());
  }
}

TYPED_TEST(EnvironmentMapOf, DirectionsAreDrawnAsTheDensitySays) {
  using T = TypeParam;
  constexpr int kWidth = 13, kHeight = 9, kParts = 2;
  for (const bool compensation : {false, true}) {
    const Environment environment = environment_of(bitmap(kWidth, kHeight), compensation);
    const EnvironmentMap<T> table(environment);
    // Each cell in four parts of equal solid angle.
    std::vector<double> counts((kHeight - 1) * kWidth * kParts * kParts), probabilities;
    for (int j = 0; j < kHeight - 1; ++j) {
      for (int i = 0; i < kWidth; ++i) {
        const double pdf = environment_pdf(
            table.data(), as<T>(direction_at(environment, (i + 1.0) / kWidth, (j + 0.5) * kPi / (kHeight - 1))));
        for (int k = 0; k < kParts * kParts; ++k) {
          probabilities.push_back(pdf * cell_solid_angle(environment, j) / (kParts * kParts));
        }
      }
    }
    Coordinates<T> random(41);
    for (int s = 0; s < 100000; ++s) {
      const T u1 = random(), u2 = random();
      const EnvironmentSample<T> drawn = sample_environment(table.data(), u1, u2);
      ASSERT_GT(drawn.pdf, 0);
      const Vec3 d(drawn.direction.x, drawn.direction.y, drawn.direction.z);
      ASSERT_NEAR(d.norm(), 1, 8 * std::numeric_limits<T>::epsilon());
      const auto [x, y] = grid_place(environment, d);
      const int i = static_cast<int>(x), j = std::min(static_cast<int>(y), kHeight - 2);
      const double step = kPi / (kHeight - 1), top = std::cos(j * step), bottom = std::cos((j + 1) * step);
      const double down = (top - std::cos(y * step)) / (top - bottom);
      const int part = (x - i < 0.5 ? 0 : 1) + (down < 0.5 ? 0 : kParts);
      const double inside = std::min({x - i, i + 1 - x, y - j, j + 1 - y});
      if (inside < 1e-5) continue;  // roundings decide on which side of a cell's edge it lies
      EXPECT_EQ(drawn.pdf, environment_pdf(table.data(), drawn.direction));
      counts[static_cast<std::size_t>((j * kWidth + i) * kParts * kParts + part)] += 1;
      const Rgb exact = bilinear(environment, d);
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(drawn.radiance[c], exact[c], 30 * kWidth * 32 * std::numeric_limits<T>::epsilon());
    }
    expect_distribution(counts, probabilities, 1e-6 / 2, compensation ? "compensated" : "plain");
  }
}

TYPED_TEST(EnvironmentMapOf, TheMeanOfRadianceOverDensityIsTheIntegral) {
  using T = TypeParam;
  const Environment environment = environment_of(bitmap(32, 17, 5));
  const EnvironmentMap<T> table(environment);
  constexpr int kSamples = 50000;
  double sum = 0, squares = 0;
  Coordinates<T> random(43);
  for (int s = 0; s < kSamples; ++s) {
    const T u1 = random(), u2 = random();
    const EnvironmentSample<T> drawn = sample_environment(table.data(), u1, u2);
    const double value = luminance(Rgb(drawn.radiance[0], drawn.radiance[1], drawn.radiance[2])) / drawn.pdf;
    sum += value, squares += value * value;
  }
  const double mean = sum / kSamples, se = std::sqrt((squares / kSamples - mean * mean) / kSamples);
  EXPECT_NEAR(mean, table.luminance_integral(), 5 * se);
  EXPECT_LT(se, 0.01 * mean);  // the density is proportional to a cell's mean, so only what varies in it is left
}

// Without compensation no direction from which light comes may have density 0, however dim beside the rest.
TYPED_TEST(EnvironmentMapOf, WhereverThereIsLightThereIsDensity) {
  using T = TypeParam;
  auto map = std::make_shared<Bitmap>();
  map->width = 64, map->height = 33;
  map->rgb.assign(3 * 64 * 33, 1e-12f);
  for (std::size_t c = 0; c < 3; ++c) map->rgb[3 * (10 * 64 + 20) + c] = 1e12f;
  for (std::size_t k = 0; k < 3 * 64 * 8; ++k) map->rgb[3 * 64 * 20 + k] = 0;
  const Environment environment = environment_of(map);
  const EnvironmentMap<T> table(environment);
  for (int j = 0; j < 32; ++j) {
    for (int i = 0; i < 64; ++i) {
      const Vec3 d = direction_at(environment, (i + 1.0) / 64, (j + 0.5) * kPi / 32);
      const T pdf = environment_pdf(table.data(), as<T>(d));
      EXPECT_EQ(pdf > 0, luminance(bilinear(environment, d)) > 0) << i << ' ' << j;
    }
  }
}

TYPED_TEST(EnvironmentMapOf, ConstantLightIsUniformAndSoIsAConstantMapCompensated) {
  using T = TypeParam;
  Environment environment;
  environment.radiance = Rgb(1, 2, 3);
  const EnvironmentMap<T> table(environment);
  EXPECT_NEAR(table.luminance_integral(), 4 * kPi * luminance(Rgb(1, 2, 3)), 1e-12);
  const EnvironmentSample<T> drawn = sample_environment(table.data(), T(0.3), T(0.6));
  EXPECT_NEAR(drawn.pdf, 0.25 / kPi, 1e-7);
  EXPECT_EQ(drawn.radiance[2], 3);
  EXPECT_EQ(environment_pdf(table.data(), drawn.direction), drawn.pdf);

  auto map = std::make_shared<Bitmap>();
  map->width = 16, map->height = 9, map->rgb.assign(3 * 16 * 9, 0.7f);
  const EnvironmentMap<T> flat(environment_of(map, true));
  std::mt19937_64 random(3);
  for (int k = 0; k < 1000; ++k) {
    EXPECT_NEAR(environment_pdf(flat.data(), as<T>(random_direction(random))), 0.25 / kPi, 1e-5 / kPi);
  }
}

TYPED_TEST(EnvironmentMapOf, ABlackMapIsStillSampled) {
  using T = TypeParam;
  auto map = std::make_shared<Bitmap>();
  map->width = 16, map->height = 9, map->rgb.assign(3 * 16 * 9, 0.f);
  for (const bool compensation : {false, true}) {
    const EnvironmentMap<T> table(environment_of(map, compensation));
    EXPECT_EQ(table.luminance_integral(), 0);
    const EnvironmentSample<T> drawn = sample_environment(table.data(), T(0.3), T(0.6));
    EXPECT_GT(drawn.pdf, 0);
    EXPECT_EQ(drawn.radiance[0], 0);
  }
}

TYPED_TEST(EnvironmentMapOf, PacketsDoWhatScalarsDo) {
  using T = TypeParam;
  using F = NativePacket<T>;
  constexpr auto kLanes = static_cast<std::size_t>(kWidth<F>);
  const Environment environment = environment_of(bitmap(13, 9));
  const EnvironmentMap<T> table(environment);
  alignas(64) std::array<T, kLanes> u1, u2, x, pdf, blue, looked_up, pdf_again;
  Coordinates<T> random(5);
  for (int k = 0; k < 1000; ++k) {
    for (std::size_t l = 0; l < kLanes; ++l) u1[l] = random(), u2[l] = random();
    const EnvironmentSample<F> p = sample_environment(table.data(), load<F>(u1.data()), load<F>(u2.data()));
    F rgb[3];
    environment_radiance(table.data(), p.direction, rgb);
    store(x.data(), p.direction.x), store(pdf.data(), p.pdf), store(blue.data(), p.radiance[2]);
    store(looked_up.data(), rgb[2]), store(pdf_again.data(), environment_pdf(table.data(), p.direction));
    for (std::size_t l = 0; l < kLanes; ++l) {
      const EnvironmentSample<T> alone = sample_environment(table.data(), u1[l], u2[l]);
      T rgb_alone[3];
      environment_radiance(table.data(), alone.direction, rgb_alone);
      EXPECT_EQ(x[l], alone.direction.x);
      EXPECT_EQ(pdf[l], alone.pdf);
      EXPECT_EQ(blue[l], alone.radiance[2]);
      EXPECT_EQ(looked_up[l], rgb_alone[2]);
      EXPECT_EQ(pdf_again[l], environment_pdf(table.data(), alone.direction));
    }
  }
}

std::string refusal(std::shared_ptr<const Bitmap> map) {
  try {
    const EnvironmentMap<float> table(environment_of(std::move(map)));
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  return "";
}

TEST(EnvironmentMap, RefusesWhatMitsubaRefusesAndWhatIsNotFinite) {
  EXPECT_EQ(refusal(bitmap(1, 5)), "sky.exr: an environment map has at least 2 x 3 pixels, not 1 x 5 pixels");
  EXPECT_NE(refusal(bitmap(5, 2)), "");
  const auto map = bitmap(5, 4);
  map->rgb[3 * 7 + 1] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(refusal(map), "sky.exr: the pixel in column 2 of row 1 is not finite");
  EXPECT_EQ(refusal(bitmap(2, 3)), "");
}

TEST(EnvironmentMap, ALargeMapIsBuiltInTimeLinearInItsPixels) {
  const auto seconds = [](int width, int height) {
    const Environment environment = environment_of(bitmap(width, height));
    const auto start = std::chrono::steady_clock::now();
    const EnvironmentMap<float> table(environment);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  seconds(256, 128);
  EXPECT_LT(seconds(1024, 512), 1.0);  // half a million pixels; a table a pixel would take hours
}

}  // namespace
}  // namespace halfslope
