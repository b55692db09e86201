#include "experiments/spec.h"

#include <gmock/gmock.h>

#include <functional>

#include "core/error.h"

namespace halfslope {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr const char* kSmallest = "scene = 'veach-mis'\nsamplers = 'independent'\nsamples = 16\n";

Error error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "nothing was wrong";
  return Error(ExitCode::kDone, "");
}

std::string refusal(const std::string& toml) {
  const Error error = error_of([&] { parse_spec_toml(toml, "x.toml"); });
  EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
  return error.what();
}

std::string flag_refusal(const std::string& key, const std::string& value) {
  Spec spec;
  const Error error = error_of([&] { apply_flag(spec, key, value); });
  EXPECT_EQ(error.code(), ExitCode::kUsage) << error.what();
  return error.what();
}

Spec with_flag(const std::string& key, const std::string& value) {
  Spec spec;
  apply_flag(spec, key, value);
  return spec;
}

TEST(SpecToml, EveryKeyArrives) {
  const Spec spec = parse_spec_toml(R"(
name = "figure 3"
scene = ["veach-mis", "aligned-phong-cap:n=1000,alpha=0.05"]
estimators = ["light", "power:3@light*3+bsdf"]
samplers = ["independent", "halton-owen"]
samples = "4:64"
replicates = 128
seed = 7
resolution = [96, 64]
pixels = 200
images = [64, 4]
precision = ["f64", "f32"]
measures = ["l2-star", "star"]
)",
                                    "x.toml");
  EXPECT_EQ(spec.name, "figure 3");
  EXPECT_THAT(spec.scenes, ElementsAre("veach-mis", "aligned-phong-cap:n=1000,alpha=0.05"));
  EXPECT_THAT(spec.estimators, ElementsAre("light", "power:3@light*3+bsdf"));
  EXPECT_THAT(spec.samplers, ElementsAre("independent", "halton-owen"));
  EXPECT_THAT(spec.samples.counts, ElementsAre(4, 8, 16, 32, 64));
  EXPECT_TRUE(spec.samples.is_range);
  EXPECT_EQ(spec.replicates, 128);
  EXPECT_EQ(spec.seed, 7u);
  EXPECT_EQ(spec.resolution, (std::array{96, 64}));
  EXPECT_EQ(spec.pixels, 200);
  EXPECT_THAT(spec.images, ElementsAre(4, 64));
  EXPECT_THAT(spec.precision, ElementsAre(Precision::kF64, Precision::kF32));
  EXPECT_THAT(spec.measures, ElementsAre("star", "l2-star"));  // the catalogue's order
  EXPECT_EQ(spec.places.at("replicates"), "x.toml:7:14");
  EXPECT_EQ(spec.codes.at("replicates"), 3);
  EXPECT_NO_THROW(validate(spec));
}

TEST(SpecToml, SingleValuesStandForLists) {
  const Spec spec = parse_spec_toml(std::string(kSmallest) + "precision = 'f64'\npixels = 'all'\n", "x.toml");
  EXPECT_THAT(spec.scenes, ElementsAre("veach-mis"));
  EXPECT_THAT(spec.samplers, ElementsAre("independent"));
  EXPECT_THAT(spec.samples.counts, ElementsAre(16));
  EXPECT_FALSE(spec.samples.is_range);
  EXPECT_THAT(spec.precision, ElementsAre(Precision::kF64));
  EXPECT_FALSE(spec.pixels);
  EXPECT_THAT(parse_spec_toml("samples = [100, 9, 4]", "x").samples.counts, ElementsAre(4, 9, 100));
}

TEST(SpecToml, UnknownKeyNamesThePlaceAndTheNearest) {
  EXPECT_THAT(refusal("seed = 1\nsamplees = 4\n"),
              StartsWith("x.toml:2:1: key 'samplees' is not known; did you mean 'samples'? allowed: name, scene, "));
  EXPECT_THAT(refusal("zzzzzzzz = 4\n"), StartsWith("x.toml:1:1: key 'zzzzzzzz' is not known; allowed: name, "));
}

TEST(SpecToml, WrongTypeSaysWhatWasFoundAndWhatIsAllowed) {
  EXPECT_EQ(refusal("\nreplicates = 'many'"),
            "x.toml:2:14: key 'replicates': found 'many'; allowed: an integer from 1 to 2^31");
  EXPECT_THAT(refusal("seed = 1.5"), HasSubstr("x.toml:1:8: key 'seed': found a floating-point number; allowed: "));
  EXPECT_THAT(refusal("samples = true"),
              HasSubstr("found a boolean; allowed: a range of powers of two such as 4:1024"));
  EXPECT_THAT(refusal("samplers = ['independent', 3]"), StartsWith("x.toml:1:28: key 'samplers': found 3; "));
  EXPECT_THAT(refusal("[scene]\nname = 'x'"), HasSubstr("key 'scene': found a table"));
  EXPECT_THAT(refusal("name = ['a']"), HasSubstr("key 'name': found a list of 1"));
  EXPECT_THAT(refusal("samples = [[4]]"), HasSubstr("found a list; "));
  EXPECT_THAT(refusal("samples = '64'"), HasSubstr("found '64'; "));
  EXPECT_THAT(refusal("pixels = 'some'"), HasSubstr("found 'some'; allowed: 'all' or an integer"));
  EXPECT_THAT(refusal("precision = 'f16'"), HasSubstr("found 'f16'; allowed: f32, f64"));
}

TEST(SpecToml, SyntaxErrorsHaveAPlace) {
  EXPECT_THAT(refusal("seed = 1\nname = \"open\nsamples = 4\n"), StartsWith("x.toml:2:"));
  EXPECT_THAT(refusal("seed = 1\nseed = 2\n"), StartsWith("x.toml:2:"));
}

TEST(SpecToml, NumbersOutsideTheirDomain) {
  EXPECT_THAT(refusal("samples = 0"), HasSubstr("key 'samples': found 0; "));
  EXPECT_THAT(refusal("samples = [4, 0]"), StartsWith("x.toml:1:15: key 'samples': found 0; "));
  EXPECT_THAT(refusal("samples = [-4]"), HasSubstr("found -4; "));
  EXPECT_THAT(refusal("samples = '0:4'"), HasSubstr("found '0'; "));
  EXPECT_THAT(refusal("replicates = 0"), HasSubstr("key 'replicates': found 0; "));
  EXPECT_THAT(refusal("replicates = 2147483649"), HasSubstr("found 2147483649; "));
  EXPECT_EQ(parse_spec_toml("replicates = 2147483648", "x").replicates, std::int64_t{1} << 31);
  EXPECT_THAT(refusal("resolution = [0, 64]"), StartsWith("x.toml:1:15: key 'resolution': found 0; "));
  EXPECT_THAT(refusal("resolution = [96, -1]"), HasSubstr("found -1; "));
  EXPECT_THAT(refusal("resolution = [96]"), HasSubstr("found a list of 1; "));
  EXPECT_THAT(refusal("resolution = 96"), HasSubstr("found 96; "));
  EXPECT_THAT(refusal("pixels = 0"), HasSubstr("key 'pixels': found 0; "));
  EXPECT_THAT(refusal("seed = -1"), HasSubstr("key 'seed': found -1; "));
  EXPECT_EQ(parse_spec_toml("seed = 0", "x").seed, 0u);
}

TEST(SpecToml, RangesAreOfPowersOfTwo) {
  EXPECT_THAT(refusal("samples = '4:1000'"), HasSubstr("1000 is not a power of two: the nearest are 512 and 1024"));
  EXPECT_THAT(refusal("samples = '3:1024'"), HasSubstr("3 is not a power of two: the nearest are 2 and 4"));
  EXPECT_THAT(refusal("samples = '64:4'"), HasSubstr("ends before it begins"));
  EXPECT_THAT(refusal("samples = '4:'"), HasSubstr("allowed: a range"));
  EXPECT_THAT(refusal("samples = '4:8:16'"), HasSubstr("allowed: a range"));
  EXPECT_THAT(refusal("samples = ['4:1024']"), HasSubstr("found '4:1024'; "));
  EXPECT_THAT(parse_spec_toml("samples = '1:1'", "x").samples.counts, ElementsAre(1));
}

TEST(SpecToml, EmptyListsAndRepetitions) {
  for (const char* key : {"scene", "estimators", "samplers", "samples", "precision", "measures"})
    EXPECT_THAT(refusal(std::string(key) + " = []"), HasSubstr("found an empty list")) << key;
  EXPECT_THAT(refusal("samplers = ['']"), HasSubstr("found an empty name"));
  EXPECT_THAT(refusal("samplers = ['n-rooks', 'n-rooks']"),
              StartsWith("x.toml:1:24: key 'samplers': 'n-rooks' stands "));
  EXPECT_THAT(refusal("samples = [4, 8, 4]"), StartsWith("x.toml:1:18: key 'samples': 4 stands there twice"));
  EXPECT_THAT(refusal("precision = ['f32', 'f32']"), HasSubstr("twice"));
}

TEST(SpecToml, MeasuresAreNamesOfTheCatalogue) {
  EXPECT_THAT(parse_spec_toml(kSmallest, "x").measures, IsEmpty());
  EXPECT_THAT(parse_spec_toml("measures = 'l2-star'", "x").measures, ElementsAre("l2-star"));
  EXPECT_THAT(parse_spec_toml("measures = 'none'", "x").measures, IsEmpty());
  EXPECT_THAT(refusal("\nmeasures = ['star', 'l2star']"),
              AllOf(StartsWith("x.toml:2:21: key 'measures': there is no measure 'l2star'; did you mean 'l2-star'? "
                               "allowed: star, l2-star, "),
                    EndsWith(", a list of different ones, or 'none'")));
  EXPECT_THAT(refusal("measures = 'everything'"),
              StartsWith("x.toml:1:12: key 'measures': there is no measure 'everything'; allowed: star, l2-star, "));
  EXPECT_THAT(refusal("measures = ['none']"), HasSubstr("'none' stands in a list; it stands alone"));
  EXPECT_THAT(refusal("measures = ['star', 'star']"), HasSubstr("'star' stands there twice"));
  EXPECT_THAT(refusal("measures = 3"), HasSubstr("key 'measures': found 3; "));
  EXPECT_THAT(refusal("measures = ''"), HasSubstr("found an empty name"));
}

TEST(SpecToml, TimingIsANumberOfRepetitions) {
  EXPECT_EQ(parse_spec_toml(kSmallest, "x").timing, 0);
  EXPECT_EQ(parse_spec_toml("timing = 15", "x").timing, 15);
  EXPECT_EQ(parse_spec_toml("timing = 'none'", "x").timing, 0);
  EXPECT_EQ(with_flag("timing", "3").timing, 3);
  for (const char* wrong : {"2", "10001", "'fast'", "[15]"})
    EXPECT_THAT(refusal(std::string("timing = ") + wrong), HasSubstr("an integer from 3 to 10000, the repetitions"));
}

TEST(SpecToml, NamesMustFitAFolder) {
  EXPECT_THAT(refusal("name = ''"), HasSubstr("empty name"));
  EXPECT_THAT(refusal("name = '../x'"), HasSubstr("found '../x'"));
  EXPECT_THAT(refusal("name = '..'"), HasSubstr("found '..'"));
}

TEST(SpecFile, MissingFileIsBadInput) {
  const Error error = error_of([] { load_spec("/nonexistent/x.toml"); });
  EXPECT_EQ(error.code(), ExitCode::kBadInput);
  EXPECT_THAT(error.what(), HasSubstr("/nonexistent/x.toml"));
}

TEST(SpecFile, TheShippedExperimentIsValid) {
  const Spec spec = load_spec(HALFSLOPE_SOURCE_DIR "/experiments/veach_mis.toml");
  EXPECT_NO_THROW(validate(spec));
  EXPECT_EQ(spec.name, "veach-mis");
  EXPECT_THAT(spec.scenes, ElementsAre("veach-mis"));
}

TEST(SpecFlags, ListsBreakAtCommas) {
  EXPECT_THAT(with_flag("estimators", "light,bsdf,power:3@light*3+bsdf").estimators,
              ElementsAre("light", "bsdf", "power:3@light*3+bsdf"));
  EXPECT_THAT(with_flag("samples", "16,4,9").samples.counts, ElementsAre(4, 9, 16));
  EXPECT_THAT(with_flag("samples", "256").samples.counts, ElementsAre(256));
  EXPECT_THAT(with_flag("precision", "f32,f64").precision, ElementsAre(Precision::kF32, Precision::kF64));
  EXPECT_THAT(with_flag("images", "4,16").images, ElementsAre(4, 16));
  EXPECT_THAT(with_flag("measures", "l2-star,star").measures, ElementsAre("star", "l2-star"));
  const Spec range = with_flag("samples", "16:64");
  EXPECT_THAT(range.samples.counts, ElementsAre(16, 32, 64));
  EXPECT_TRUE(range.samples.is_range);
}

TEST(SpecFlags, ParametersOfASceneSurviveTheirCommas) {
  EXPECT_THAT(with_flag("scene", "aligned-phong-cap:n=1000,alpha=0.05").scenes,
              ElementsAre("aligned-phong-cap:n=1000,alpha=0.05"));
  EXPECT_THAT(with_flag("scene", "veach-mis,aligned-phong-cap:n=1000,alpha=0.05,quarterdisk,mis-toy:a=1,b=2").scenes,
              ElementsAre("veach-mis", "aligned-phong-cap:n=1000,alpha=0.05", "quarterdisk", "mis-toy:a=1,b=2"));
}

TEST(SpecFlags, Scalars) {
  EXPECT_EQ(with_flag("resolution", "96,64").resolution, (std::array{96, 64}));
  EXPECT_EQ(with_flag("resolution", "96x64").resolution, (std::array{96, 64}));
  EXPECT_EQ(with_flag("pixels", "200").pixels, 200);
  EXPECT_FALSE(with_flag("pixels", "all").pixels);
  EXPECT_EQ(with_flag("seed", "18446744073709551615").seed, 18446744073709551615u);
  EXPECT_EQ(with_flag("replicates", "8").replicates, 8);
  EXPECT_EQ(with_flag("name", "a,b").name, "a,b");
  EXPECT_EQ(with_flag("name", "2024").name, "2024");
}

TEST(SpecFlags, ErrorsNameTheFlagAndAreUsage) {
  EXPECT_THAT(flag_refusal("samples", "4:1000"),
              StartsWith("--samples: found '4:1000', and 1000 is not a power of two"));
  EXPECT_THAT(flag_refusal("samples", "4:16,64"), StartsWith("--samples: found '4:16'; allowed: "));
  EXPECT_THAT(flag_refusal("samples", "4,x"), StartsWith("--samples: found 'x'; allowed: "));
  EXPECT_THAT(flag_refusal("samples", "4,4"), StartsWith("--samples: '4' stands there twice"));
  EXPECT_THAT(flag_refusal("replicates", "0"), StartsWith("--replicates: found '0'; allowed: "));
  EXPECT_THAT(flag_refusal("replicates", "64,32"), StartsWith("--replicates: found '64,32'; allowed: "));
  EXPECT_THAT(flag_refusal("seed", "-1"), StartsWith("--seed: found '-1'; "));
  EXPECT_THAT(flag_refusal("seed", "99999999999999999999"), StartsWith("--seed: found "));
  EXPECT_THAT(flag_refusal("resolution", "0x64"), StartsWith("--resolution: found '0'; "));
  EXPECT_THAT(flag_refusal("resolution", "96"), StartsWith("--resolution: found '96'; "));
  EXPECT_THAT(flag_refusal("scene", ""), StartsWith("--scene: found an empty name"));
  EXPECT_THAT(flag_refusal("measures", "star,start"),
              StartsWith("--measures: there is no measure 'start'; did you mean 'star'? allowed: star, l2-star, "));
  EXPECT_THAT(flag_refusal("samplers", "a,,b"), StartsWith("--samplers: found an empty name"));
  EXPECT_THAT(flag_refusal("samplees", "4"), StartsWith("--samplees is not known; did you mean 'samples'? allowed: "));
}

TEST(SpecFlags, AFlagReplacesTheFilesValue) {
  Spec spec = parse_spec_toml(std::string(kSmallest) + "pixels = 5\n", "x.toml");
  apply_flag(spec, "samplers", "halton-owen");
  apply_flag(spec, "samples", "4:8");
  apply_flag(spec, "pixels", "all");
  EXPECT_THAT(spec.samplers, ElementsAre("halton-owen"));
  EXPECT_THAT(spec.samples.counts, ElementsAre(4, 8));
  EXPECT_FALSE(spec.pixels);
  apply_flag(spec, "measures", "star");
  apply_flag(spec, "measures", "none");
  EXPECT_THAT(spec.measures, IsEmpty());
  EXPECT_EQ(spec.places.at("samplers"), "--samplers");
  EXPECT_EQ(spec.codes.at("samplers"), 2);
  EXPECT_EQ(spec.places.at("scene"), "x.toml:1:9");
}

TEST(SpecValidate, MissingKeysNameTheRemedy) {
  const Spec file = parse_spec_toml("scene = 'a'\nsamples = 4\n", "x.toml");
  const Error in_file = error_of([&] { validate(file); });
  EXPECT_EQ(in_file.code(), ExitCode::kBadInput);
  EXPECT_STREQ(in_file.what(), "x.toml: key 'samplers' is missing: add it, or give --samplers");
  const Error in_empty_file = error_of([] { validate(parse_spec_toml("", "x.toml")); });
  EXPECT_EQ(in_empty_file.code(), ExitCode::kBadInput);
  const Error in_flags = error_of([] { validate(with_flag("scene", "a")); });
  EXPECT_EQ(in_flags.code(), ExitCode::kUsage);
  EXPECT_THAT(in_flags.what(), StartsWith("--samplers is missing"));
}

TEST(SpecValidate, ImagesAreAmongTheSamples) {
  Spec spec = parse_spec_toml(std::string(kSmallest) + "images = [16]", "x.toml");
  EXPECT_NO_THROW(validate(spec));
  apply_flag(spec, "samples", "4:8");
  const Error error = error_of([&] { validate(spec); });
  EXPECT_EQ(error.code(), ExitCode::kUsage);
  EXPECT_THAT(error.what(), StartsWith("x.toml:4:10: image count 16 is not among the samples of --samples (4, 8)"));
  apply_flag(spec, "images", "none");
  EXPECT_NO_THROW(validate(spec));
  EXPECT_THAT(spec.images, IsEmpty());
  const Error in_file = error_of([] { validate(parse_spec_toml(std::string(kSmallest) + "images = [4]", "x.toml")); });
  EXPECT_EQ(in_file.code(), ExitCode::kBadInput);
}

TEST(SpecJson, IsCanonical) {
  const Spec spec = parse_spec_toml(std::string(kSmallest), "x.toml");
  EXPECT_EQ(canonical_json(spec),
            R"({"estimators":[],"images":[],"pixels":"all","precision":["f32"],"replicates":64,"resolution":null,)"
            R"("samplers":["independent"],"samples":[16],"scene":["veach-mis"],"seed":1})");
}

// Without measures the key is not there: hashes of experiments that have none stay what they were before it was.
TEST(SpecJson, MeasuresLeaveTheRunWhatItIs) {
  Spec spec = parse_spec_toml(kSmallest, "x.toml");
  const std::string without = canonical_json(spec);
  apply_flag(spec, "measures", "star,l2-star");
  EXPECT_EQ(canonical_json(spec), without);
}

TEST(SpecJson, TimingLeavesTheRunWhatItIs) {
  Spec spec = parse_spec_toml(kSmallest, "x.toml");
  const std::string without = canonical_json(spec);
  apply_flag(spec, "timing", "15");
  EXPECT_EQ(canonical_json(spec), without);
}

TEST(SpecJson, SameNumbersSameHash) {
  const Spec file = parse_spec_toml(std::string(kSmallest) + "name = 'x'", "x.toml");
  Spec flags = with_flag("samples", "16:16");
  apply_flag(flags, "samplers", "independent");
  apply_flag(flags, "scene", "veach-mis");
  EXPECT_EQ(spec_hash(file), spec_hash(flags));
  EXPECT_EQ(spec_hash(file).size(), 16u);
}

TEST(SpecJson, EveryKeyThatChangesNumbersChangesTheHash) {
  const Spec base = parse_spec_toml(kSmallest, "x.toml");
  const std::vector<std::pair<const char*, const char*>> changes = {
      {"scene", "quarterdisk"}, {"estimators", "light"}, {"samplers", "n-rooks"},
      {"samples", "16,32"},     {"images", "16"},        {"replicates", "65"},
      {"resolution", "96x64"},  {"pixels", "5"},         {"seed", "2"},
      {"precision", "f64"}};
  for (const auto& [key, value] : changes) {
    Spec other = base;
    apply_flag(other, key, value);
    EXPECT_NE(spec_hash(base), spec_hash(other)) << key;
  }
}

}  // namespace
}  // namespace halfslope
