#include "samplers/file_points.h"

#include <gmock/gmock.h>

#include <fstream>
#include <thread>

#include "core/error.h"
#include "tests/experiments/temporary_folder.h"
#include "tests/samplers/points.h"

namespace halfslope {
namespace {

const Layout kPair = {{2}};

class FilePoints : public testing::Test {
 protected:
  FilePoints() {
    // Twenty sets of five points (s/32 + i/256, i/8).
    std::string text;
    for (int s = 0; s < 20; ++s) {
      text += "#\n";
      for (int i = 0; i < 5; ++i) text += std::to_string(s / 32.0 + i / 256.0) + "00 " + std::to_string(i / 8.0) + "\n";
    }
    write(text);
  }
  void write(const std::string& text) const { std::ofstream(path_) << text; }

  const TemporaryFolder folder_;
  const std::string path_ = (folder_ / "points.txt").string(), name_ = "file:" + path_;
};

TEST_F(FilePoints, SetsAreReplicates) {
  const auto sampler = sampler_named(name_);
  for (const std::uint32_t replicate : {0u, 3u, 4u, 16u}) {
    const Points points = points_of(*sampler, 5, kPair, replicate, 7, kTestKey, 0, 2);
    for (int lane = 0; lane < kLanes && static_cast<int>(replicate) + lane < 20; ++lane) {
      for (std::uint64_t i = 0; i < 5; ++i) {
        // Six decimals of s/32 + i/256 round the last of its digits.
        EXPECT_NEAR(points(0, i, lane), (static_cast<int>(replicate) + lane) / 32.0 + static_cast<double>(i) / 256,
                    1e-6);
        EXPECT_EQ(points(1, i, lane), static_cast<double>(i) / 8);
      }
    }
  }
}

TEST_F(FilePoints, AreTheSameInEveryPixelAndSeedAndForEveryPrefix) {
  const auto sampler = sampler_named(name_);
  const Points points = points_of(*sampler, 5, kPair);
  EXPECT_EQ(points, points_of(*sampler, 5, kPair, 0, 8));
  EXPECT_EQ(points, points_of(*sampler, 5, kPair, 0, 7, stream_key(2, "test", "points")));
  const Points prefix = points_of(*sampler, 3, kPair), first = points_of(*sampler, 5, {{1}});
  for (std::uint64_t i = 0; i < 3; ++i) EXPECT_EQ(prefix.at(1, i, 2), points.at(1, i, 2));
  for (std::uint64_t i = 0; i < 5; ++i) EXPECT_EQ(first.at(0, i, 2), points.at(0, i, 2));
}

TEST_F(FilePoints, DeclareWhatTheFileHolds) {
  const auto sampler = sampler_named(name_);
  const SamplerInfo& info = sampler->info();
  EXPECT_EQ(info.name, name_);
  EXPECT_TRUE(info.sequence && info.randomised);
  EXPECT_FALSE(info.unbiased);
  EXPECT_EQ(info.replicates_of(64), 20);
  EXPECT_EQ(info.max_dims, 2);
  EXPECT_EQ(info.max_count, 5u);
  EXPECT_THAT(info.caveats, testing::Contains(testing::HasSubstr("20 sets are its replicates, whatever `replicates`")));
  EXPECT_THAT(info.caveats, testing::Contains(testing::HasSubstr("the same points stand in every pixel")));
  EXPECT_FALSE(sampler->illegal(3, kPair));
  const auto more = sampler->illegal(6, kPair);
  ASSERT_TRUE(more);
  EXPECT_EQ(more->below, 5u);
  EXPECT_EQ(more->above, std::nullopt);
  EXPECT_EQ(point_file_of(name_), path_);
  EXPECT_EQ(point_file_of("file-wrap:a:b"), "a:b");
  EXPECT_EQ(point_file_of("halton"), "");
  EXPECT_EQ(point_file_of("profile:x"), "");
}

TEST_F(FilePoints, OneSetIsDeterministic) {
  write("0.5 0.5\n0.25 0.25\n");
  const auto sampler = sampler_named(name_);
  EXPECT_FALSE(sampler->info().randomised);
  EXPECT_EQ(sampler->info().replicates_of(64), 1);
  const Points points = points_of(*sampler, 2, kPair);
  EXPECT_EQ(points, points_of(*sampler, 2, kPair, 5));
}

TEST_F(FilePoints, AreWrappedOrClampedOnlyWhereTheNameSaysSo) {
  write("0.5 1.25\n");
  EXPECT_THROW(sampler_named(name_), Error);
  const auto wrapped = sampler_named("file-wrap:" + path_), clamped = sampler_named("file-clamp:" + path_);
  EXPECT_EQ(points_of(*wrapped, 1, kPair)(1, 0, 0), 0.25);
  EXPECT_EQ(points_of(*clamped, 1, kPair)(1, 0, 0), 1 - 0x1p-53);
  EXPECT_THAT(wrapped->info().caveats,
              testing::Contains("1 of 2 coordinates were outside [0, 1) and were taken modulo 1"));
  EXPECT_THAT(clamped->info().caveats,
              testing::Contains("1 of 2 coordinates were outside [0, 1) and were moved to the nearest end"));
  EXPECT_NE(wrapped->info().fingerprint, clamped->info().fingerprint);
}

TEST_F(FilePoints, AFileIsReadOnceForACatalogueAndItsCopies) {
  const SamplerCatalogue catalogue = SamplerCatalogue::built_in(), copy = catalogue;
  const std::string before = catalogue.make(name_)->info().fingerprint;
  write("0.5 0.5\n");
  EXPECT_EQ(catalogue.make(name_)->info().fingerprint, before);
  EXPECT_EQ(copy.make(name_)->info().fingerprint, before);
  EXPECT_NE(SamplerCatalogue::built_in().make(name_)->info().fingerprint, before);
}

TEST_F(FilePoints, ThreadsMayAskAtTheSameTime) {
  const SamplerCatalogue catalogue = SamplerCatalogue::built_in();
  std::vector<std::string> fingerprints(8);
  {
    std::vector<std::jthread> threads;
    for (std::string& fingerprint : fingerprints)
      threads.emplace_back([&] { fingerprint = catalogue.make(name_)->info().fingerprint; });
  }
  EXPECT_THAT(fingerprints, testing::Each(sampler_named(name_)->info().fingerprint));
}

}  // namespace
}  // namespace halfslope
