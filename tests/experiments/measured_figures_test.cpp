// points, discrepancy, pcf and spectra as they are called: from samplers and files to what stands on the page.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/atomic_file.h"
#include "core/error.h"
#include "experiments/figures.h"
#include "experiments/panel_grid.h"
#include "tests/experiments/command_line_fixture.h"
#include "tests/experiments/csv_table.h"
#include "tests/experiments/svg_reading.h"

namespace halfslope {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

class MeasuredFigures : public CommandLine {
 protected:
  std::string path(const char* name) const { return (folder_ / name).string(); }
  pugi::xml_document draw(const std::vector<std::string>& arguments) const {
    const Ended ended =
        command(std::vector<std::string>{"figure"} + arguments + std::vector<std::string>{"--out", path("f.svg")});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, IsEmpty());
    pugi::xml_document document;
    EXPECT_TRUE(document.load_file(path("f.svg").c_str()));
    return document;
  }
  std::string refused(const std::vector<std::string>& arguments, int code = 2) const {
    const Ended ended =
        command(std::vector<std::string>{"figure"} + arguments + std::vector<std::string>{"--out", path("x.svg")});
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_THAT(ended.err, StartsWith("halfslope: "));
    EXPECT_FALSE(std::filesystem::exists(path("x.svg")));
    return ended.err;
  }
};

// Every mean and both ends of its interval are those that `measure --summary` prints, and the slope is that of a line
// fitted to them here.
TEST_F(MeasuredFigures, DiscrepancyIsWhatMeasureSays) {
  const std::vector<std::string> asked = {
      "--samplers", "independent,jittered,halton", "--measures", "l2-star", "--replicates", "24", "--seed", "7"};
  const auto document = draw(std::vector<std::string>{"discrepancy", "--samples", "16:256"} + asked);
  const CsvTable table(command(std::vector<std::string>{"measure", "--count", "16:256", "--summary"} + asked).out);
  const LogMap x(place_of(document, "16", true), 16, place_of(document, "256", true), 256);
  const LogMap y(place_of(document, "10⁻¹", false), 0.1, place_of(document, "10⁻²", false), 0.01);
  std::size_t row = 0;
  for (const auto& group : document.select_nodes("//g")) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    auto bar = group.node().child("polyline").next_sibling("polyline");
    for (const Place& p : points_of(group.node().child("polyline"))) {
      ASSERT_EQ("l2-star, " + table.text(row, "sampler"), group.node().child_value("title"));
      const double count = table.number(row, "count"), value = table.number(row, "value");
      EXPECT_NEAR(x.value(p.x), count, 3e-4 * count);
      EXPECT_NEAR(y.value(p.y), value, 3e-4 * value);
      if (bar) {
        const auto ends = points_of(bar);
        EXPECT_NEAR(y.value(ends[0].y), table.number(row, "lower"), 3e-4 * value);
        EXPECT_NEAR(y.value(ends[1].y), table.number(row, "upper"), 3e-4 * value);
        bar = bar.next_sibling("polyline").next_sibling("polyline").next_sibling("polyline");  // past two caps
      }
      n += 1, sx += std::log(count), sy += std::log(value);
      sxx += std::log(count) * std::log(count), sxy += std::log(count) * std::log(value);
      ++row;
    }
    const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    EXPECT_THAT(texts(document), Contains(ContainsRegex(fmt::format("^−{:.2f}", -slope))));
  }
  EXPECT_EQ(row, table.size());
  EXPECT_EQ(row, 5u + 3 + 5);  // jittered has squares alone
}

TEST_F(MeasuredFigures, AnInstructiveDiscrepancyNeedsNoFlag) {
  const auto document = draw({"discrepancy"});
  EXPECT_GE(document.select_nodes("//g").size(), 4u);
  EXPECT_THAT(texts(document),
              AllOf(Contains("star against N"), Contains(HasSubstr("16 replicates, seed 1")), Contains("−½")));
}

// The curves likewise: every value on the page is one that `measure --summary` prints.
TEST_F(MeasuredFigures, CurvesAreWhatMeasureSays) {
  for (const auto& [figure, parameters, unit, other] :
       {std::tuple{"pcf", "bins=30,max=0.25", 16.0, "3"}, {"radial-spectrum", "size=40", 1.0, "20"}}) {
    const std::string measure = std::string(figure) + ":" + parameters;
    const std::vector<std::string> asked = {
        "--samplers", "independent,jittered", "--measures", measure, "--replicates", "20", "--seed", "3"};
    const auto document = draw(std::vector<std::string>{figure, "--samples", "256"} + asked);
    const CsvTable table(command(std::vector<std::string>{"measure", "--count", "256", "--summary"} + asked).out);
    const LinearMap x(place_of(document, "0", true), 0, place_of(document, other, true), std::stod(other));
    const LinearMap y(place_of(document, "0", false), 0, place_of(document, "1", false), 1);
    std::size_t row = 0;
    for (const auto& group : document.select_nodes("//g")) {
      for (const Place& p : points_of(group.node().child("polyline"))) {
        const std::string& name = table.text(row, "measure");
        EXPECT_EQ(table.text(row, "sampler"), group.node().child_value("title"));
        EXPECT_NEAR(x.value(p.x), unit * std::stod(name.substr(name.find('=') + 1)), 1e-3);
        EXPECT_NEAR(y.value(p.y), table.number(row, "value"), 1e-3);
        ++row;
      }
    }
    EXPECT_EQ(row, table.size());
  }
}

TEST_F(MeasuredFigures, MoreValuesThanMemoryAreRefusedBeforeTheWork) {
  const Ended ended = command({"figure", "spectrum", "--samplers", "independent", "--samples", "1024", "--replicates",
                               "4096", "--out", path("x.svg")});
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.err,
              HasSubstr("its 68161536 values of all replicates are more than the 33554432"));  // 129 · 129 · 4096
  EXPECT_LT(ended.seconds, 5);
  // Four samplers, each of which alone would do.
  const Ended four = command({"figure", "spectrum", "--samplers", "independent,jittered,halton-owen,n-rooks",
                              "--samples", "1024", "--replicates", "1024", "--out", path("x.svg")});
  EXPECT_EQ(four.code, 2);
  EXPECT_THAT(four.err, HasSubstr("68161536 values are more than the 33554432 that are held; ask for fewer"));
  EXPECT_LT(four.seconds, 5);
}

TEST_F(MeasuredFigures, TheSameBytesWhateverTheThreads) {
  std::set<std::string> bytes;
  for (const char* threads : {"1", "2", "5"}) {
    ASSERT_EQ(command({"figure", "discrepancy", "--samplers", "independent,halton-owen,n-rooks", "--samples", "4:512",
                       "--replicates", "40", "--measures", "star,l2-star", "--threads", threads, "--quiet", "-o",
                       path("f.png")})
                  .code,
              0);
    bytes.insert(read_file(path("f.png")));
  }
  EXPECT_EQ(bytes.size(), 1u);
}

TEST_F(MeasuredFigures, PointsOfTwoDimensionsOfMany) {
  const auto document = draw({"points", "--samplers", "halton,stratified", "--axes", "5,4", "--samples", "36"});
  const auto groups = document.select_nodes("//g");
  ASSERT_EQ(groups.size(), 2u);
  for (const auto& group : groups) {
    const CsvTable points(
        command({"points", "--sampler", group.node().child_value("title"), "--count", "36", "--dims", "6"}).out);
    const auto frame = points_of(group.node().child("polygon"));
    std::size_t row = 0;
    for (const auto& circle : group.node().children("circle")) {
      const double side = frame[1].x - frame[0].x;
      EXPECT_NEAR((circle.attribute("cx").as_double() - frame[0].x) / side, points.number(row, "x5"), 1e-5);
      EXPECT_NEAR((frame[2].y - circle.attribute("cy").as_double()) / side, points.number(row, "x4"), 1e-5);
      ++row;
    }
    EXPECT_EQ(row, 36u);
  }
  EXPECT_THAT(texts(document), Contains(HasSubstr("Dimensions 5 (to the right) and 4 (upwards)")));
}

TEST_F(MeasuredFigures, WrongUsageSaysWhatIsAllowed) {
  for (const auto& [arguments, message] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"points", "--axes", "1"}, "--axes: found ''; allowed: two different dimensions"},
           {{"points", "--axes", "1,1"}, "--axes: found '1,1'"},
           {{"points", "--axes", "-1,1"}, "--axes: found '-1,1'"},
           {{"points", "--axes", "0,1,2"}, "--axes"},
           {{"points", "--samplers", "jittered", "--samples", "99"}, "the nearest legal: 81 and 100"},
           {{"points", "--samplers", "halton", "--axes", "0,5000"}, "5001 are needed"},
           {{"points", "--wrap"}, "--wrap: is about the points of --points FILE"},
           {{"points", "--wrap", "--clamp", "--points", "x"}, "excludes"},
           {{"points", "--dims", "3"}, "--dims: the figure 'points' does not take it"},
           {{"points", "--side-by-side"}, "--side-by-side: the figure 'points' does not take it"},
           {{"veach", "--points", "x"}, "--points: the figure 'veach' does not take it"},
           {{"discrepancy", "--samplers", "haltn"}, "did you mean 'halton'?"},
           {{"discrepancy", "--measures", "str"}, "--measures: there is no measure 'str'"},
           {{"discrepancy", "--samples", "4,5", "--samplers", "jittered"}, "the nearest legal: 4 and 9"},
           {{"discrepancy", "--samples", "5:7", "--samplers", "jittered"}, "--samples"},
           {{"discrepancy", "--replicates", "0"}, "--replicates: found '0'; allowed: an integer from 1 to 4096"},
           {{"discrepancy", "--replicates", "many"}, "--replicates: found 'many'"},
           {{"discrepancy", "--dims", "0"}, "--dims: found '0'"},
           {{"discrepancy", "--dims", "3", "--samplers", "independent", "--measures", "dispersion"},
            "dispersion at N = 16"},
           {{"pcf", "--samples", "16:64"}, "one N at a time"},
           {{"pcf", "--measures", "star"}, "the figure 'pcf' does not draw 'star'; allowed: pcf"},
           {{"spectrum", "--measures", "star"}, "the figure 'spectrum' does not draw 'star'; allowed: spectrum"}}) {
    EXPECT_THAT(refused(arguments), HasSubstr(message));
  }
}

TEST_F(MeasuredFigures, EveryFlagIsInTheHelpAndEveryFigureInTheList) {
  const std::string help = command({"figure", "--help"}).out;
  for (const FigureInfo& figure : figure_catalogue()) {
    for (const std::string& flag : figure.flags) EXPECT_THAT(help, HasSubstr("--" + flag));
    EXPECT_THAT(command({"list", "figures", "--names"}).out, HasSubstr(figure.name + "\n"));
  }
}

/// Points on the diagonal under any name.
class Diagonal : public Sampler {
 public:
  explicit Diagonal(const std::string& name) {
    info_.name = name;
    info_.max_dims = 8;
    info_.randomised = false;
  }
  const SamplerInfo& info() const override { return info_; }
  void prepare(const PointRequest& request) override { count_ = request.count; }
  void fill(std::uint64_t begin, PointBlock& block) override {
    for (int d = 0; d < block.dims(); ++d) {
      for (std::size_t i = 0; i < block.stride(); ++i) {
        block.high(d)[i] = static_cast<std::uint32_t>((begin + i / kLanes) * (std::uint64_t{1} << 32) / count_);
        if (block.has_low_words()) block.low(d)[i] = 0;
      }
    }
  }

 private:
  SamplerInfo info_;
  std::uint64_t count_ = 1;
};

Catalogue of_diagonals(const std::vector<std::string>& names) {
  Catalogue catalogue;
  for (const std::string& name : names)
    catalogue.samplers.add([name]() -> std::unique_ptr<Sampler> { return std::make_unique<Diagonal>(name); });
  return catalogue;
}

int strata_lines(const std::string& name, std::uint64_t count, std::array<int, 2> axes) {
  FigureRequest request;
  request.name = "points";
  request.spec.samplers = {name};
  request.spec.samples.counts = {count};
  request.axes = axes;
  const Canvas canvas = draw_points_figure(request, of_diagonals({name}));
  int lines = 0;
  for (const Canvas::Element& element : canvas.elements()) {
    const auto* path = std::get_if<Canvas::Path>(&element);
    lines += path && path->paint.stroke && path->paint.stroke->ink == Ink{215, 215, 215};
  }
  return lines;
}

TEST(PointsFigure, StrataAreThoseOfTheTwoDimensions) {
  EXPECT_EQ(strata_lines("regular", 49, {0, 1}), 6 + 6);
  EXPECT_EQ(strata_lines("regular", 49, {0, 2}), 0);  // the cells are three-dimensional
  EXPECT_EQ(strata_lines("multi-jittered", 24, {0, 1}), 5 + 3);
  EXPECT_EQ(strata_lines("correlated-multi-jittered", 24, {3, 2}), 5 + 3);
  EXPECT_EQ(strata_lines("correlated-multi-jittered", 24, {1, 2}), 0);  // not a pair
  EXPECT_EQ(strata_lines("orthogonal-array", 25, {1, 4}), 4 + 4);       // strength 2: any two dimensions
  EXPECT_EQ(strata_lines("n-rooks", 7, {1, 4}), 6 + 6);
  EXPECT_EQ(strata_lines("hammersley", 16, {0, 1}), 0);
}

TEST(PointsFigure, EachCellBetweenTheLinesHoldsOnePoint) {
  for (const auto& [name, count] : std::vector<std::pair<std::string, std::uint64_t>>{{"regular", 49},
                                                                                      {"jittered", 49},
                                                                                      {"stratified", 24},
                                                                                      {"multi-jittered", 24},
                                                                                      {"correlated-multi-jittered", 24},
                                                                                      {"orthogonal-array", 49}}) {
    FigureRequest request;
    request.name = "points";
    request.spec.samplers = {name};
    request.spec.samples.counts = {count};
    request.axes = {1, 0};
    const Canvas canvas = draw_points_figure(request, Catalogue::built_in());
    std::vector<double> across, up;  // where the lines are
    std::set<std::pair<std::ptrdiff_t, std::ptrdiff_t>> cells;
    for (const Canvas::Element& element : canvas.elements()) {
      if (const auto* path = std::get_if<Canvas::Path>(&element)) {
        if (!path->paint.stroke || path->paint.stroke->ink != Ink{215, 215, 215}) continue;
        const bool vertical = path->points[0].x == path->points[1].x;
        (vertical ? across : up).push_back(vertical ? path->points[0].x : path->points[0].y);
      }
      if (const auto* disc = std::get_if<Canvas::Disc>(&element)) {
        const auto place = [](const std::vector<double>& lines, double at) {
          return std::count_if(lines.begin(), lines.end(), [&](double line) { return line < at; });
        };
        EXPECT_TRUE(cells.insert({place(across, disc->center.x), place(up, disc->center.y)}).second) << name;
      }
    }
    EXPECT_EQ((across.size() + 1) * (up.size() + 1), count) << name;
    EXPECT_EQ(cells.size(), count) << name;
  }
}

TEST(PointsFigure, TwentyFourPanelsFitAPage) {
  for (std::size_t count = 1; count <= 24; ++count) {
    const PanelGrid grid(count, 25, 18);
    EXPECT_LE(grid.height(), 684) << count;  // 9.5 inches
    EXPECT_GE(grid.side(), 84) << count;
    std::set<std::pair<double, double>> places;
    for (std::size_t k = 0; k < count; ++k) {
      const Position at = grid.top_left(k);
      EXPECT_GE(at.x, 20);
      EXPECT_LE(at.x + grid.side(), kPageWidth);
      EXPECT_LE(at.y + 25 + grid.side() + 18, grid.height() + 1e-9);
      for (const auto& [x, y] : places) {
        EXPECT_TRUE(std::fabs(at.x - x) >= grid.side() + 8 || std::fabs(at.y - y) >= grid.side() + 40)
            << "panels " << k << " of " << count << " overlap";
      }
      places.insert({at.x, at.y});
    }
  }
  std::vector<std::string> names;
  for (int k = 0; k < 25; ++k) names.push_back("sampler-" + std::to_string(k));
  FigureRequest request;
  request.name = "points";
  request.spec.samplers = names;
  try {
    draw_points_figure(request, of_diagonals(names));
    FAIL() << "25 panels";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    EXPECT_THAT(error.what(), HasSubstr("at most 24 panels"));
  }
}

}  // namespace
}  // namespace halfslope
