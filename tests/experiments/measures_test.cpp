// discrepancy.csv: what is measured, of which points, and that it is the same bytes every time.
#include "experiments/measures.h"

#include <gmock/gmock.h>

#include <cmath>
#include <csignal>

#include "analysis/discrepancy.h"
#include "core/error.h"
#include "experiments/engine.h"
#include "experiments/interrupt.h"
#include "tests/experiments/command_line_fixture.h"
#include "tests/experiments/csv_table.h"
#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

using Keys = std::map<std::string, std::string>;

/// Points (i + ½)/N in both dimensions, N even: deterministic, a set, with one or two dimensions.
class Diagonal : public Sampler {
 public:
  explicit Diagonal(int dims) {
    info_.name = dims == 1 ? "line" : "diagonal";
    info_.randomised = false;
    info_.max_dims = dims;
  }
  const SamplerInfo& info() const override { return info_; }
  std::optional<LegalNeighbours> illegal(std::uint64_t count, const Layout&) const override {
    return count % 2 == 0 ? std::nullopt : std::optional(LegalNeighbours{count - 1, count + 1});
  }
  void prepare(const PointRequest& request) override { count_ = request.count; }
  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) {
      for (std::size_t i = 0; i < block.stride(); ++i) {
        const double x = (static_cast<double>(begin + i / kLanes) + 0.5) / static_cast<double>(count_);
        block.high(d)[i] = static_cast<std::uint32_t>(x * 0x1p32);
        if (block.has_low_words()) block.low(d)[i] = 0;
      }
    }
  }

 private:
  SamplerInfo info_;
  std::uint64_t count_ = 1;
};

Catalogue with_diagonals() {
  Catalogue catalogue = Catalogue::built_in();
  catalogue.samplers.add([] { return std::make_unique<Diagonal>(1); });
  catalogue.samplers.add([] { return std::make_unique<Diagonal>(2); });
  return catalogue;
}

using Discrepancy = CommandLine;

// Every row against the analysis of the points that `halfslope points` prints.
TEST_F(Discrepancy, IsThatOfThePrintedPoints) {
  const std::vector<std::string> samplers = {"halton-owen", "stratified", "n-rooks", "independent"};
  ASSERT_EQ(run({"--scene", "quarterdisk", "--samplers", "halton-owen,stratified,n-rooks,independent", "--samples",
                 "4,16,64", "--replicates", "18", "--seed", "5", "--measures", "l2-star,star"})
                .code,
            0);
  const CsvTable table = CsvTable::read(folder_ / "out/discrepancy.csv");
  EXPECT_THAT(table.columns(),
              ElementsAre("sampler", "dims", "count", "replicate", "measure", "value", "lower", "upper", "method"));
  ASSERT_EQ(table.size(), 4u * 3 * 18 * 2);
  std::size_t row = 0;
  for (const std::string& sampler : samplers) {
    for (const std::string count : {"4", "16", "64"}) {
      for (int replicate = 0; replicate < 18; ++replicate) {
        std::vector<double> x, y;
        if (replicate % 17 == 0) {  // the first of a group of lanes, and one of the next group
          const CsvTable points(command({"points", "--sampler", sampler, "--count", count, "--dims", "2", "--seed", "5",
                                         "--replicate", std::to_string(replicate)})
                                    .out);
          for (std::size_t i = 0; i < points.size(); ++i)
            x.push_back(points.number(i, "x0")), y.push_back(points.number(i, "x1"));
        }
        for (const std::string measure : {"star", "l2-star"}) {
          EXPECT_EQ(table.text(row, "sampler"), sampler);
          EXPECT_EQ(table.text(row, "dims"), "2");
          EXPECT_EQ(table.text(row, "count"), count);
          EXPECT_EQ(table.text(row, "replicate"), std::to_string(replicate));
          EXPECT_EQ(table.text(row, "measure"), measure);
          EXPECT_EQ(table.text(row, "lower"), table.text(row, "value"));
          EXPECT_EQ(table.text(row, "upper"), table.text(row, "value"));
          EXPECT_EQ(table.text(row, "method"), "exact");
          if (!x.empty()) {
            const PointSet points({x, y});
            EXPECT_EQ(table.number(row, "value"),
                      measure == "star" ? star_discrepancy(points) : l2_star_discrepancy(points))
                << sampler << ' ' << count << ' ' << replicate;
          }
          ++row;
        }
      }
    }
  }
}

// Large sets travel fewer lanes at a time; every replicate is still its own.
TEST_F(Discrepancy, OfLargeSetsIsThatOfThePrintedPoints) {
  ASSERT_EQ(run({"--scene", "quarterdisk", "--samplers", "n-rooks", "--samples", "65536", "--replicates", "6",
                 "--measures", "l2-star"})
                .code,
            0);
  const CsvTable table = CsvTable::read(folder_ / "out/discrepancy.csv");
  ASSERT_EQ(table.size(), 6u);
  for (const std::size_t replicate : {0, 5}) {
    const CsvTable points(command({"points", "--sampler", "n-rooks", "--count", "65536", "--dims", "2", "--replicate",
                                   std::to_string(replicate)})
                              .out);
    std::vector<double> x, y;
    for (std::size_t i = 0; i < points.size(); ++i)
      x.push_back(points.number(i, "x0")), y.push_back(points.number(i, "x1"));
    EXPECT_EQ(table.number(replicate, "value"), l2_star_discrepancy(PointSet({x, y})));
  }
}

TEST_F(Discrepancy, ThreadsChangeNothing) {
  std::string bytes;
  for (const char* threads : {"1", "2", "5"}) {
    ASSERT_EQ(run({"--scene", "quarterdisk", "--samplers", "halton-owen,stratified,independent", "--samples", "4:1024",
                   "--replicates", "40", "--measures", "star,l2-star", "--threads", threads, "--overwrite"})
                  .code,
              0);
    const std::string now = read_file(folder_ / "out/discrepancy.csv");
    EXPECT_TRUE(bytes.empty() || bytes == now) << threads;
    bytes = now;
  }
  EXPECT_EQ(CsvTable(bytes).size(), 3u * 9 * 40 * 2);
}

TEST_F(Discrepancy, WithoutMeasuresThereIsNoTable) {
  ASSERT_EQ(run({"--measures", "star"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/discrepancy.csv"));
  const std::string journal = read_file(folder_ / "out/journal");
  // Measures are of the points alone: the run is the same, and nothing of it is done again.
  ASSERT_EQ(run({"--measures", "none"}).code, 0);
  EXPECT_EQ(read_file(folder_ / "out/journal"), journal);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/discrepancy.csv"));
}

TEST_F(Discrepancy, WrongNamesAreRefused) {
  EXPECT_THAT(refusal({"--measures", "stars"}, 2), HasSubstr("--measures: there is no measure 'stars'; did you mean"));
  EXPECT_THAT(file_refusal("scene = 'mis-toy'\nsamplers = 'independent'\nsamples = 4\nmeasures = ['str']\n"),
              AllOf(HasSubstr("4:13: key 'measures': there is no measure 'str'"), HasSubstr("'star'")));
}

TEST_F(Discrepancy, TheSummaryAndTheDryRunTellOfIt) {
  const std::vector<std::string> asked = {"run",        "--out",       out(),         "--scene", "quarterdisk",
                                          "--samplers", "halton-owen", "--samples",   "4:16",    "--replicates",
                                          "16",         "--measures",  "star,l2-star"};
  const Ended dry = command(asked + std::vector<std::string>{"--dry-run"});
  EXPECT_THAT(dry.out, HasSubstr("\n  discrepancy, halton-owen: star + l2-star at N = 4 … 16, 16 replicates, 2 "
                                 "dimensions\nskipped:\n"));
  EXPECT_THAT(command(asked + std::vector<std::string>{"--dry-run", "--json"}).out, HasSubstr("\"discrepancies\": 96"));
  const Ended ended = command(asked);
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("done: run, discrepancy, 448 samples in "));
  const CsvTable table = CsvTable::read(folder_ / "out/discrepancy.csv");
  // The mean of each over 16 replicates, and 2.131 standard errors (Student's t, 15 degrees of freedom) to both sides.
  std::string row = "\n  halton-owen  16 +16";
  for (const std::size_t measure : {0, 1}) {
    double mean = 0, squares = 0;
    for (std::size_t r = 64 + measure; r < 96; r += 2) mean += table.number(r, "value") / 16;
    for (std::size_t r = 64 + measure; r < 96; r += 2) squares += std::pow(table.number(r, "value") - mean, 2);
    const double half = 2.13144954556 * std::sqrt(squares / 15 / 16);
    row += fmt::format(" +{:.3g} +\\[{:.3g}, {:.3g}\\]", mean, mean - half, mean + half);
  }
  EXPECT_THAT(ended.out, ContainsRegex(row + "\n"));
  EXPECT_THAT(read_file(folder_ / "out/manifest.json"), HasSubstr("\"measures\": ["));
}

std::vector<std::uint64_t> counts_of(const MeasuredPoints& points) {
  std::vector<std::uint64_t> counts;
  for (const MeasuredCount& n : points.counts) counts.push_back(n.count);
  return counts;
}

// 2^20 points are measured in a moment, a billion would take the machine: they are left out, and it is said.
TEST(MeasuresPlan, SaysWhatIsLeftOut) {
  const Catalogue catalogue = with_diagonals();
  Keys keys = {{"scene", "quarterdisk"}, {"samplers", "diagonal"}, {"samples", "2:16"}, {"measures", "star"}};
  Spec spec = spec_of(keys);
  spec.samples.counts = {1, 2, 3, 4, 1 << 20, 1 << 21, std::uint64_t{1} << 40};
  spec.samplers = {"line", "diagonal", "independent"};
  spec.replicates = 10000;
  std::vector<std::string> left_out;
  const MeasuresPlan plan = plan_measures(spec, catalogue.samplers, left_out);
  EXPECT_THAT(left_out, Contains("measures: sampler 'line' has at most 1 dimension, not 2: left out"));
  EXPECT_THAT(left_out, Contains("measures: sampler 'diagonal' cannot make N = 1, 3 points in 2 dimensions: left "
                                 "out"));
  EXPECT_THAT(left_out, Contains("measures: N = 2097152, 1099511627776: left out, since at most 1048576 points are "
                                 "measured"));
  EXPECT_THAT(left_out, Contains("measures: replicates 4096 to 9999 left out: the first 4096 are measured"));
  ASSERT_EQ(plan.points.size(), 3u);
  EXPECT_THAT(plan.points[0].counts, IsEmpty());
  EXPECT_THAT(counts_of(plan.points[1]), ElementsAre(2, 4, 1 << 20));
  EXPECT_EQ(plan.points[1].replicates, 1);
  EXPECT_THAT(counts_of(plan.points[2]), ElementsAre(1, 2, 3, 4, 1 << 20));
  EXPECT_EQ(plan.points[2].replicates, 4096);
  EXPECT_EQ(plan.rows(), 3u + 5 * 4096);

  const Plan whole = make_plan(spec_of(keys), catalogue);
  EXPECT_THAT(counts_of(whole.measures.points[0]), ElementsAre(2, 4, 8, 16));
  EXPECT_THAT(whole.left_out, IsEmpty());
  keys["samples"] = "1:16";
  const Plan ranged = make_plan(spec_of(keys), catalogue);
  for (const auto& lines : {ranged.left_out, ranged.skips})
    EXPECT_THAT(lines, Contains("measures: sampler 'diagonal' cannot make N = 1 points in 2 dimensions: left out"));
  keys.erase("measures");
  const Plan none = make_plan(spec_of(keys), catalogue);
  EXPECT_EQ(none.measures.rows(), 0u);
  EXPECT_THAT(none.skips, Not(Contains(HasSubstr("measures:"))));
  EXPECT_THAT(describe_measures(none.measures), IsEmpty());
}

// Of points (x, x), x = (i + ½)/N, the worst box is a closed square up to one of them, with i + 1 points.
TEST(Measures, OfASamplerThatAnEmbedderAdds) {
  const RunScope scope;
  scope.run({{"scene", "quarterdisk"},
             {"samplers", "diagonal"},
             {"samples", "2,4,8"},
             {"measures", "star"},
             {"replicates", "30"}},
            "out", with_diagonals());
  const CsvTable table = scope.table("discrepancy.csv");
  ASSERT_EQ(table.size(), 3u);
  for (std::size_t row = 0; row < 3; ++row) {
    const double n = 2 << row;
    double star = 0;
    for (double i = 0; i < n; ++i) star = std::max(star, (i + 1) / n - std::pow((i + 0.5) / n, 2));
    EXPECT_EQ(table.number(row, "count"), n);
    EXPECT_DOUBLE_EQ(table.number(row, "value"), star);
  }
}

TEST(Measures, StopForASignal) {
  Spec spec =
      spec_of({{"scene", "quarterdisk"}, {"samplers", "independent"}, {"samples", "4:64"}, {"measures", "star"}});
  std::vector<std::string> left_out;
  const Catalogue catalogue = Catalogue::built_in();
  const MeasuresPlan plan = plan_measures(spec, catalogue.samplers, left_out);
  const InterruptGuard guard;
  ::raise(SIGINT);
  try {
    measure_points(plan, catalogue.samplers, 2, "", true);
    ADD_FAILURE() << "went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kInterrupted);
    EXPECT_THAT(error.what(), HasSubstr("interrupted while points were measured"));
  }
}

}  // namespace
}  // namespace halfslope
