#include "samplers/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace halfslope {
namespace {

TEST(SamplerCatalogue, OffersTheNearestName) {
  try {
    SamplerCatalogue::built_in().make("halton-owne");
    FAIL() << "made";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'halton-owen'?"));
  }
}

class Corner final : public Sampler {
 public:
  const SamplerInfo& info() const override {
    static const SamplerInfo kInfo = {
        .name = "corner", .description = "the origin", .reference = "none", .randomised = false, .max_dims = 9};
    return kInfo;
  }
  void prepare(const PointRequest&) override {}
  void fill(std::uint64_t, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) std::fill_n(block.high(d), block.stride(), 0u);
  }
};

TEST(SamplerCatalogue, AUsersSamplerStandsBesideTheBuiltInOnes) {
  SamplerCatalogue catalogue = SamplerCatalogue::built_in();
  const std::size_t before = catalogue.list().size();
  EXPECT_FALSE(catalogue.has("corner"));
  catalogue.add([] { return std::make_unique<Corner>(); });
  EXPECT_TRUE(catalogue.has("corner"));
  ASSERT_EQ(catalogue.list().size(), before + 1);
  EXPECT_EQ(catalogue.list().back().name, "corner");
  EXPECT_EQ(catalogue.make("corner")->info().description, "the origin");
}

TEST(SamplerCatalogueDeathTest, ANameIsTakenOnce) {
  SamplerCatalogue catalogue = SamplerCatalogue::built_in();
  EXPECT_DEATH(catalogue.add([] { return SamplerCatalogue::built_in().make("n-rooks"); }), "a sampler of that name");
}

}  // namespace
}  // namespace halfslope
