// The convergence figure, drawn from run folders that are written here, and read back from its SVG.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <set>

#include "core/atomic_file.h"
#include "core/csv.h"
#include "experiments/convergence_panels.h"
#include "tests/experiments/command_line_fixture.h"
#include "tests/experiments/svg_reading.h"

namespace halfslope {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

struct Row {
  std::string estimator, sampler;
  int samples;
  std::optional<double> rmse, lo, hi;
  std::string status = "ok";
  std::string scene = "toy:n=1,k=2", precision = "f64";
};

class ConvergenceFigure : public CommandLine {
 protected:
  std::string write_run(const std::vector<Row>& rows) const {
    const std::filesystem::path run = folder_ / "my run";
    std::filesystem::create_directories(run);
    CsvWriter csv({"scene", "estimator", "sampler", "precision", "samples", "rmse", "rmse_lo", "rmse_hi", "status"});
    for (const Row& r : rows)
      csv.row(r.scene, r.estimator, r.sampler, r.precision, r.samples, r.rmse, r.lo, r.hi, r.status);
    std::ofstream(run / "convergence.csv") << csv.text();
    return run.string();
  }
  pugi::xml_document draw(const std::string& run, const std::vector<std::string>& more = {}) const {
    const std::string out = (folder_ / "c.svg").string();
    const Ended ended = command(std::vector<std::string>{"figure", "convergence", "--run", run, "-o", out} + more);
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, IsEmpty());
    pugi::xml_document document;
    EXPECT_TRUE(document.load_file(out.c_str()));
    return document;
  }
};

TEST_F(ConvergenceFigure, EveryPointStandsAtItsLogarithms) {
  const std::vector<Row> rows = {{"mean", "independent", 4, 0.5, 0.4, 0.7},
                                 {"mean", "independent", 64, 0.11, 0.1, 0.13},
                                 {"mean", "independent", 1024, 0.03, 0.02, 0.04},
                                 {"mean", "halton", 4, 0.3, {}, {}, "deterministic"},
                                 {"mean", "halton", 64, 0.02, {}, {}, "deterministic"},
                                 {"mean", "halton", 1024, 0.0007, {}, {}, "deterministic"}};
  const auto document = draw(write_run(rows));
  const LogMap x(place_of(document, "4", true), 4, place_of(document, "1024", true), 1024);
  const LogMap y(place_of(document, "10⁻¹", false), 0.1, place_of(document, "10⁻³", false), 1e-3);
  const auto groups = document.select_nodes("//g");
  ASSERT_EQ(groups.size(), 2u);
  // Coordinates have three decimals: a thousandth of a point is a relative 5e-5 at the most on these axes.
  const double tolerance = 2e-4;
  const auto near = [&](double found, double expected) { EXPECT_NEAR(found, expected, tolerance * expected); };

  const auto first = groups[0].node();
  EXPECT_STREQ(first.child_value("title"), "toy:n=1,k=2, mean, independent, f64");
  std::size_t row = 0;
  for (const auto& circle : first.children("circle")) {
    near(x.value(circle.attribute("cx").as_double()), rows[row].samples);
    near(y.value(circle.attribute("cy").as_double()), *rows[row].rmse);
    ++row;
  }
  EXPECT_EQ(row, 3u);
  // The line, then for each point a bar and two caps.
  std::vector<std::vector<Place>> lines;
  for (const auto& line : first.children("polyline")) lines.push_back(points_of(line));
  ASSERT_EQ(lines.size(), 1u + 3 * 3);
  for (std::size_t k = 0; k < 3; ++k) {
    near(y.value(lines[0][k].y), *rows[k].rmse);
    near(y.value(lines[1 + 3 * k][0].y), *rows[k].lo);
    near(y.value(lines[1 + 3 * k][1].y), *rows[k].hi);
    near(x.value(lines[1 + 3 * k][0].x), rows[k].samples);
  }
  // A deterministic sampler has no bars; its markers are squares.
  const auto second = groups[1].node();
  row = 3;
  for (const auto& square : second.children("polygon")) {
    Place middle{0, 0};
    for (const Place& p : points_of(square)) middle.x += p.x / 4, middle.y += p.y / 4;
    near(x.value(middle.x), rows[row].samples);
    near(y.value(middle.y), *rows[row].rmse);
    ++row;
  }
  EXPECT_EQ(row, 6u);
  EXPECT_EQ(std::distance(second.children("polyline").begin(), second.children("polyline").end()), 1);
  EXPECT_THAT(texts(document), AllOf(Contains("my run"), Contains("toy:n=1,k=2, mean, f64"), Contains("independent"),
                                     Contains("halton"), Contains("RMSE"), Contains("samples N"), Contains("−½"),
                                     Contains("−¾"), Contains("−1"), Contains("−3/2")));
}

TEST_F(ConvergenceFigure, WhatHasNoRmseIsLeftOutAndSaid) {
  const std::string run = write_run({{"mean", "a", 4, 0.5, 0.4, 0.7},
                                     {"mean", "a", 16, 0.2, {}, 0.3, "few-replicates"},
                                     {"mean", "a", 64, {}, {}, {}, "reference-limited"},
                                     {"mean", "b", 4, 0, 0, 0, "exact"},
                                     {"mean", "b", 16, 0, 0, 0, "exact"}});
  const auto document = draw(run);
  const auto groups = document.select_nodes("//g");
  ASSERT_EQ(groups.size(), 2u);
  std::vector<std::string> fills;
  for (const auto& circle : groups[0].node().children("circle")) fills.emplace_back(circle.attribute("fill").value());
  EXPECT_THAT(fills, ElementsAre("#0072b2", "#ffffff"));  // the second's interval is not certified
  EXPECT_FALSE(groups[1].node().child("polygon"));
  EXPECT_THAT(texts(document), Contains("exact"));  // in the legend, where the rate would stand
  EXPECT_THAT(texts(document), Contains(AllOf(HasSubstr("Hollow"), HasSubstr("left out"))));
  draw(write_run({{"mean", "b", 4, 0, 0, 0, "exact"}}));              // nothing at all to draw
  draw(write_run({{"mean", "b", 4, 0.1, {}, {}, "deterministic"}}));  // a single point
}

TEST_F(ConvergenceFigure, TheLegendHasTheRatesOverTheWidestRange) {
  const std::string run = write_run({{"mean", "a", 4, 0.5, 0.4, 0.7},
                                     {"mean", "a", 64, 0.1, 0.08, 0.12},
                                     {"mean", "b", 4, 0.5, {}, {}, "deterministic"}});
  EXPECT_THAT(texts(draw(run)), Not(Contains("rate [95 %]")));
  std::ofstream(folder_ / "my run/rates.csv")
      << "scene,estimator,sampler,precision,rate,rate_lo,rate_hi,samples_lo,samples_hi,theory,status\n"
         "\"toy:n=1,k=2\",mean,a,f64,-9,-9,-9,16,64,,ok\n"
         "\"toy:n=1,k=2\",mean,a,f64,-0.504,-0.617,-0.4,4,64,,ok\n"
         "\"toy:n=1,k=2\",mean,b,f64,,,,,,,too-few-points\n"
         "other,mean,b,f64,-1,,,,,,ok\n";
  EXPECT_THAT(texts(draw(run)), AllOf(Contains("rate [95 %]"), Contains("−0.50 [−0.62, −0.40]"),
                                      Contains("too-few-points"), Not(Contains(HasSubstr("−9")))));
}

TEST_F(ConvergenceFigure, FiltersChooseLines) {
  std::vector<Row> rows;
  for (const char* estimator : {"light", "bsdf"}) {
    for (const char* sampler : {"a", "b"}) {
      for (const int n : {4, 16}) rows.push_back({estimator, sampler, n, 1.0 / n, {}, {}, "deterministic"});
    }
  }
  const std::string run = write_run(rows);
  const auto titles = [&](const std::vector<std::string>& more) {
    const auto document = draw(run, more);
    std::vector<std::string> found;
    for (const auto& node : document.select_nodes("//g/title")) found.push_back(node.node().child_value());
    return found;
  };
  EXPECT_EQ(titles({}).size(), 4u);
  EXPECT_THAT(titles({"--estimators", "light"}),
              ElementsAre("toy:n=1,k=2, light, a, f64", "toy:n=1,k=2, light, b, f64"));
  EXPECT_THAT(titles({"--estimator", "bsdf", "--sampler", "b"}), ElementsAre("toy:n=1,k=2, bsdf, b, f64"));
  EXPECT_EQ(titles({"--scene", "toy:n=1,k=2", "--precision", "f64"}).size(), 4u);
  for (const auto& [flag, value] :
       {std::pair("--samplers", "c"), {"--estimators", "ligth"}, {"--precision", "f32"}, {"--scene", "toy"}}) {
    const Ended ended =
        command({"figure", "convergence", "--run", run, flag, value, "-o", (folder_ / "x.svg").string()});
    EXPECT_EQ(ended.code, 2) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr(std::string(flag) + ": the run has no "));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x.svg"));
}

TEST_F(ConvergenceFigure, ARunsFolderIsDrawnAsItStands) {
  ASSERT_EQ(run({"--samples", "4:64", "--name", "toy & more"}).code, 0);
  const auto document = draw(out());
  EXPECT_THAT(texts(document), Contains("toy & more"));
  EXPECT_EQ(document.select_nodes("//g").size(), 5u);  // light, bsdf, average, balance, power
  const std::string png = (folder_ / "c.png").string();
  EXPECT_EQ(command({"figure", "convergence", "--run", out(), "-o", png}).code, 0);
  EXPECT_TRUE(read_file(png).starts_with("\x89PNG"));
}

TEST_F(ConvergenceFigure, ABrokenRunFolderIsBadInputWithWhatToDo) {
  const auto refused = [&](const std::string& folder) {
    const Ended ended = command({"figure", "convergence", "--run", folder, "-o", (folder_ / "x.png").string()});
    EXPECT_EQ(ended.code, 3) << ended.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "x.png"));
    return ended.err;
  };
  EXPECT_THAT(refused((folder_ / "none").string()), HasSubstr("make one with `halfslope run"));
  std::filesystem::create_directories(folder_ / "my run");
  EXPECT_THAT(refused((folder_ / "my run").string()), HasSubstr("repeat its command"));
  const auto broken = [&](const std::string& text) {
    std::ofstream(folder_ / "my run/convergence.csv") << text;
    return refused((folder_ / "my run").string());
  };
  const std::string head = "scene,estimator,sampler,precision,samples,rmse,rmse_lo,rmse_hi,status\n";
  EXPECT_THAT(broken(""), HasSubstr("convergence.csv: is empty"));
  EXPECT_THAT(broken(head), HasSubstr("nothing was measured"));
  EXPECT_THAT(broken("a,b\n1,2\n"), HasSubstr("there is no column 'scene'"));
  EXPECT_THAT(broken(head + "s,e,p,f32,4,0.1,,\n"), HasSubstr("convergence.csv:2: found 8 cells"));
  EXPECT_THAT(broken(head + "s,e,p,f32,4,abc,,,ok\n"), HasSubstr("column 'rmse': found 'abc'"));
  EXPECT_THAT(broken(head + "s,e,p,f32,0,0.1,,,ok\n"), HasSubstr("'samples'"));
  const Ended missing = command({"figure", "convergence"});
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("--run is missing"));
}

// The same points, N · ns · 1e-9 seconds to the right, with bars both ways.
TEST_F(ConvergenceFigure, WorkPrecisionStandsOverTime) {
  const std::string run = write_run({{"mean", "a", 4, 0.5, 0.4, 0.7}, {"mean", "a", 64, 0.1, 0.08, 0.12}});
  const auto refused = [&] {
    const Ended ended = command({"figure", "work-precision", "--run", run, "-o", (folder_ / "x.svg").string()});
    EXPECT_EQ(ended.code, 3) << ended.err;
    return ended.err;
  };
  EXPECT_THAT(refused(), HasSubstr("there is no timing.csv: run the experiment again with the key `timing`"));
  const std::string head = "scene,estimator,sampler,precision,samples,ns_per_sample,ns_lo,ns_hi\n";
  std::ofstream(folder_ / "my run/timing.csv") << head + "\"toy:n=1,k=2\",mean,a,f64,4,50,,60\n";
  EXPECT_THAT(refused(), HasSubstr("ns_lo"));
  std::ofstream(folder_ / "my run/timing.csv") << head +
                                                      "\"toy:n=1,k=2\",mean,a,f64,4,50,40,60\n"
                                                      "\"toy:n=1,k=2\",mean,a,f64,64,500,400,600\n"
                                                      "other,mean,a,f64,64,500,400,600\n";
  const std::string out = (folder_ / "w.svg").string();
  ASSERT_EQ(command({"figure", "work-precision", "--run", run, "-o", out}).code, 0);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file(out.c_str()));
  const LogMap x(place_of(document, "10⁻⁶", true), 1e-6, place_of(document, "10⁻⁵", true), 1e-5);
  const auto group = document.select_node("//g").node();
  std::vector<double> seconds;
  for (const auto& circle : group.children("circle")) seconds.push_back(x.value(circle.attribute("cx").as_double()));
  ASSERT_EQ(seconds.size(), 2u);
  EXPECT_NEAR(seconds[0], 2e-7, 2e-10);
  EXPECT_NEAR(seconds[1], 32e-6, 2e-8);
  // The line; then of each point a bar along x with two caps, and one along y.
  std::vector<std::vector<Place>> lines;
  for (const auto& line : group.children("polyline")) lines.push_back(points_of(line));
  ASSERT_EQ(lines.size(), 1u + 2 * 6);
  EXPECT_NEAR(x.value(lines[1][0].x), 1.6e-7, 2e-10);
  EXPECT_NEAR(x.value(lines[1][1].x), 2.4e-7, 2e-10);
  EXPECT_THAT(texts(document), Contains("CPU seconds an integral"));
}

// Slopes halfway between their N, hollow outside the window and where not certified, with a level for what theory says.
TEST_F(ConvergenceFigure, RatesStandBetweenTheirN) {
  const std::string run = write_run({{"mean", "a", 4, 0.5, 0.4, 0.7}, {"mean", "b", 4, 0, 0, 0, "exact"}});
  const auto ended = [&] { return command({"figure", "rates", "--run", run, "-o", (folder_ / "r.svg").string()}); };
  EXPECT_EQ(ended().code, 3);
  EXPECT_THAT(ended().err, HasSubstr("there is no local_rates.csv"));
  const std::string head = "scene,estimator,sampler,precision,samples_lo,samples_hi,rate,rate_lo,rate_hi,status\n";
  std::ofstream(folder_ / "my run/local_rates.csv") << head + "\"toy:n=1,k=2\",mean,a,f64,16,4,-1,,,ok\n";
  EXPECT_EQ(ended().code, 3);
  EXPECT_THAT(ended().err, HasSubstr("samples_lo 16 and samples_hi 4"));
  std::ofstream(folder_ / "my run/local_rates.csv") << head +
                                                           "\"toy:n=1,k=2\",mean,a,f64,4,16,-0.25,-0.4,-0.1,ok\n"
                                                           "\"toy:n=1,k=2\",mean,a,f64,16,64,-0.5,-9,9,ok\n"
                                                           "\"toy:n=1,k=2\",mean,a,f64,64,256,-0.75,,,heavy-tailed\n"
                                                           "\"toy:n=1,k=2\",mean,b,f64,4,16,,,,exact\n"
                                                           "other,mean,a,f64,64,256,-7,,,ok\n";
  std::ofstream(folder_ / "my run/rates.csv")
      << "scene,estimator,sampler,precision,rate,rate_lo,rate_hi,samples_lo,samples_hi,theory,status\n"
         "\"toy:n=1,k=2\",mean,a,f64,-0.45,-0.5,-0.4,4,256,-0.5,pre-asymptotic\n"
         "\"toy:n=1,k=2\",mean,a,f64,-0.62,-0.7,-0.5,16,256,-0.5,asymptotic\n";
  ASSERT_EQ(ended().code, 0);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file((folder_ / "r.svg").c_str()));
  EXPECT_THAT(texts(document),
              AllOf(Contains("rate over all N [95 %], theory"), Contains("−0.45 [−0.50, −0.40]*, −½"), Contains("−½"),
                    Contains("rate between neighbouring N"), Contains("exact"), Contains(HasSubstr("Hollow"))));
  const LogMap x(place_of(document, "16", true), 16, place_of(document, "64", true), 64);
  const LinearMap y(place_of(document, "−0.2", false), -0.2, place_of(document, "−0.6", false), -0.6);
  const auto group = document.select_node("//g").node();
  std::vector<double> samples, rates;
  std::vector<std::string> fills;
  for (const auto& circle : group.children("circle")) {
    samples.push_back(x.value(circle.attribute("cx").as_double()));
    rates.push_back(y.value(circle.attribute("cy").as_double()));
    fills.emplace_back(circle.attribute("fill").value());
  }
  using ::testing::DoubleNear;
  EXPECT_THAT(samples, ElementsAre(DoubleNear(8, 0.01), DoubleNear(32, 0.04), DoubleNear(128, 0.15)));
  EXPECT_THAT(rates, ElementsAre(DoubleNear(-0.25, 1e-4), DoubleNear(-0.5, 1e-4), DoubleNear(-0.75, 1e-4)));
  EXPECT_THAT(fills, ElementsAre("#ffffff", "#0072b2", "#ffffff"));
}

TEST(ConvergencePanels, AreSmallEnoughToRead) {
  std::vector<ConvergenceLine> lines;
  const auto add = [&](const std::string& scene, int estimators, int samplers) {
    for (int e = 0; e < estimators; ++e) {
      for (int s = 0; s < samplers; ++s)
        lines.push_back({scene, "e" + std::to_string(e), "s" + std::to_string(s), "f32"});
    }
  };
  add("x", 2, 4);
  add("y", 3, 3);
  add("z", 1, 17);
  const auto panels = convergence_panels(lines).panels;
  std::vector<std::string> titles;
  std::size_t drawn = 0;
  std::map<std::string, std::size_t> look;
  for (const ConvergencePanel& panel : panels) {
    titles.push_back(panel.title);
    drawn += panel.lines.size();
    EXPECT_LE(panel.lines.size(), 8u);
    std::set<std::size_t> used;
    for (const PanelLine& line : panel.lines) EXPECT_TRUE(used.insert(line.look).second);
  }
  EXPECT_THAT(titles, ElementsAre("x", "y, e0", "y, e1", "y, e2", "z, e0", "z, e0", "z, e0"));
  EXPECT_EQ(drawn, lines.size());

  lines.clear();
  add("x", 3, 4);  // an estimator a panel, and a sampler has one look in all of them
  const auto few = convergence_panels(lines);
  EXPECT_EQ(few.common, "x, f32");
  ASSERT_EQ(few.panels.size(), 3u);
  for (const ConvergencePanel& panel : few.panels) {
    for (const PanelLine& line : panel.lines) {
      EXPECT_EQ(line.label, line.line->sampler);
      EXPECT_EQ(look.emplace(line.label, line.look).first->second, line.look);
    }
  }
}

}  // namespace
}  // namespace halfslope
