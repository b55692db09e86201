#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/experiments/run_spec.h"

namespace halfslope {
namespace {

// What theorems promise is what is measured. With 256 replicates a slope over N = 64 … 4096 has a standard error below
// 0.015, and logarithms and the first N move it by 0.06 (docs/rates.md): 0.15 off is beyond six of the one after the
// other.
TEST(TheoryColumn, HoldsTheRatesThatAreMeasured) {
  const RunScope scope;
  scope.run({{"scene", "stepx,quarterdisk,bilinear"},
             {"samplers", "independent,stratified,n-rooks,halton-cp,sobol-owen,hammersley-owen"},
             {"samples", "64:4096"},
             {"replicates", "256"},
             {"precision", "f64"}});
  const CsvTable rates = scope.table("rates.csv");
  const std::map<std::string, std::string> promised = {
      {"stepx", "-0.5 -0.75 -1 -1 -1 -1 "},
      {"quarterdisk", "-0.5 -0.75 -0.5 - -0.75 -0.75 "},
      {"bilinear", "-0.5 -1 -0.5 -1 -1.5 -1.5 "},
  };
  std::map<std::string, std::string> found;
  std::set<std::string> seen;
  for (std::size_t r = 0; r < rates.size(); ++r) {
    const std::string what = rates.text(r, "scene") + ", " + rates.text(r, "sampler");
    if (!seen.insert(what).second) continue;  // the first row of a line is over every N
    std::string& line = found[rates.text(r, "scene")];
    const std::string theory = rates.text(r, "theory");
    line += (theory.empty() ? "-" : theory) + " ";
    if (theory.empty()) continue;
    EXPECT_NEAR(rates.number(r, "rate"), rates.number(r, "theory"), 0.15) << what;
  }
  EXPECT_EQ(found, promised);
}

}  // namespace
}  // namespace halfslope
