// Quadratic discrepancies of known point sets: computed elsewhere, twice, or published.
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/quadratic_discrepancy.h"
#include "tests/analysis/digital_nets.h"

namespace halfslope {
namespace {

Columns sobol_net(int dims, int m) { return net(sobol_matrices(dims, 16), m); }

Columns midpoints(int count) {
  Columns columns(1);
  for (int i = 0; i < count; ++i) columns[0].push_back((i + 0.5) / count);
  return columns;
}

enum Power { kRoot = 1, kSquared = 2 };

struct Case {
  double (*measure)(const PointSet&);
  Power power;
  Columns points;
  double value, tolerance;
};

TEST(QuadraticDiscrepancy, OfKnownPointSets) {
  const std::vector<Case> cases = {
      {centered_l2_discrepancy, kSquared,
       columns_of(
           {{1. / 6, 1. / 6, 1. / 6}, {1. / 6, 1. / 6, 5. / 6}, {1. / 6, 3. / 6, 1. / 6}, {1. / 6, 3. / 6, 3. / 6},
            {1. / 6, 3. / 6, 5. / 6}, {1. / 6, 5. / 6, 1. / 6}, {1. / 6, 5. / 6, 3. / 6}, {1. / 6, 5. / 6, 5. / 6},
            {3. / 6, 1. / 6, 1. / 6}, {3. / 6, 1. / 6, 3. / 6}, {3. / 6, 1. / 6, 5. / 6}, {3. / 6, 3. / 6, 1. / 6},
            {3. / 6, 3. / 6, 3. / 6}, {3. / 6, 3. / 6, 5. / 6}, {3. / 6, 5. / 6, 1. / 6}, {3. / 6, 5. / 6, 3. / 6},
            {5. / 6, 1. / 6, 1. / 6}, {5. / 6, 1. / 6, 3. / 6}, {5. / 6, 1. / 6, 5. / 6}, {5. / 6, 3. / 6, 3. / 6},
            {5. / 6, 3. / 6, 5. / 6}, {5. / 6, 5. / 6, 1. / 6}, {5. / 6, 5. / 6, 3. / 6}, {5. / 6, 5. / 6, 5. / 6}}),
       0.0327789208962088, 1e-12},
      {centered_l2_discrepancy, kSquared,
       columns_of({{3. / 4, 1. / 4, 1. / 4, 3. / 4, 3. / 4, 3. / 4},
                   {1. / 4, 3. / 4, 3. / 4, 3. / 4, 3. / 4, 3. / 4},
                   {3. / 4, 1. / 4, 1. / 4, 1. / 4, 1. / 4, 1. / 4},
                   {1. / 4, 1. / 4, 1. / 4, 1. / 4, 3. / 4, 3. / 4},
                   {1. / 4, 3. / 4, 3. / 4, 3. / 4, 1. / 4, 1. / 4},
                   {3. / 4, 3. / 4, 3. / 4, 3. / 4, 1. / 4, 1. / 4},
                   {3. / 4, 3. / 4, 3. / 4, 1. / 4, 3. / 4, 3. / 4}}),
       0.31716801819952645, 1e-12},
      {centered_l2_discrepancy, kSquared, halton(0, 64, 2), 0.0007340847364807335, 1e-13},
      {centered_l2_discrepancy, kSquared, sobol_net(3, 6), 0.0005947820123695102, 1e-13},
      {centered_l2_discrepancy, kSquared, midpoints(7), 0.0017006802721088435, 1e-12},
      {centered_l2_discrepancy, kSquared,
       columns_of({{1. / 12, 9. / 12},
                   {3. / 12, 7. / 12},
                   {5. / 12, 5. / 12},
                   {7. / 12, 3. / 12},
                   {9. / 12, 1. / 12},
                   {11. / 12, 11. / 12}}),
       0.010456854423869011, 1e-12},
      {centered_l2_discrepancy, kSquared, sobol_net(2, 8), 1.663160380993567e-05, 1e-13},
      {centered_l2_discrepancy, kSquared, sobol_net(2, 6), 0.00024001962608743987, 1e-13},
      {centered_l2_discrepancy, kSquared,
       columns_of({{1. / 12, 5. / 12},
                   {3. / 12, 11. / 12},
                   {5. / 12, 3. / 12},
                   {7. / 12, 9. / 12},
                   {9. / 12, 1. / 12},
                   {11. / 12, 7. / 12}}),
       0.008142039609053464, 1e-12},
      {centered_l2_discrepancy, kSquared, halton(0, 256, 2), 6.666207182726147e-05, 1e-13},
      {centered_l2_discrepancy, kSquared, midpoints(64), 2.0345052083333332e-05, 1e-12},
      {mixture_l2_discrepancy, kSquared,
       columns_of({{3. / 4, 1. / 4, 1. / 4, 3. / 4, 3. / 4, 3. / 4},
                   {1. / 4, 3. / 4, 3. / 4, 3. / 4, 3. / 4, 3. / 4},
                   {3. / 4, 1. / 4, 1. / 4, 1. / 4, 1. / 4, 1. / 4},
                   {1. / 4, 1. / 4, 1. / 4, 1. / 4, 3. / 4, 3. / 4},
                   {1. / 4, 3. / 4, 3. / 4, 3. / 4, 1. / 4, 1. / 4},
                   {3. / 4, 3. / 4, 3. / 4, 3. / 4, 1. / 4, 1. / 4},
                   {3. / 4, 3. / 4, 3. / 4, 1. / 4, 3. / 4, 3. / 4}}),
       2.499950475328891, 1e-12},
      {wraparound_l2_discrepancy, kSquared, halton(0, 64, 3), 0.001446714908857949, 1e-13},
      {wraparound_l2_discrepancy, kSquared, sobol_net(2, 8), 2.4205397090248937e-05, 1e-13},
      {wraparound_l2_discrepancy, kSquared,
       columns_of(
           {{1. / 6, 1. / 6, 1. / 6}, {1. / 6, 1. / 6, 5. / 6}, {1. / 6, 3. / 6, 1. / 6}, {1. / 6, 3. / 6, 3. / 6},
            {1. / 6, 3. / 6, 5. / 6}, {1. / 6, 5. / 6, 1. / 6}, {1. / 6, 5. / 6, 3. / 6}, {1. / 6, 5. / 6, 5. / 6},
            {3. / 6, 1. / 6, 1. / 6}, {3. / 6, 1. / 6, 3. / 6}, {3. / 6, 1. / 6, 5. / 6}, {3. / 6, 3. / 6, 1. / 6},
            {3. / 6, 3. / 6, 3. / 6}, {3. / 6, 3. / 6, 5. / 6}, {3. / 6, 5. / 6, 1. / 6}, {3. / 6, 5. / 6, 3. / 6},
            {5. / 6, 1. / 6, 1. / 6}, {5. / 6, 1. / 6, 3. / 6}, {5. / 6, 1. / 6, 5. / 6}, {5. / 6, 3. / 6, 3. / 6},
            {5. / 6, 3. / 6, 5. / 6}, {5. / 6, 5. / 6, 1. / 6}, {5. / 6, 5. / 6, 3. / 6}, {5. / 6, 5. / 6, 5. / 6}}),
       0.10085162322816635, 1e-12},
      {wraparound_l2_discrepancy, kSquared, midpoints(64), 4.0690104166666664e-05, 1e-12},
      {wraparound_l2_discrepancy, kSquared, halton(0, 64, 2), 0.00036796406445183116, 1e-13},
      {wraparound_l2_discrepancy, kSquared, midpoints(1), 0.16666666666666666, 1e-12},
      {wraparound_l2_discrepancy, kSquared, halton(0, 64, 4), 0.0036143090330722494, 1e-13},
      {wraparound_l2_discrepancy, kSquared, halton(0, 256, 3), 0.0001292928863745324, 1e-13},
      {wraparound_l2_discrepancy, kSquared,
       columns_of({{3. / 4, 1. / 4, 1. / 4, 3. / 4, 3. / 4, 3. / 4},
                   {1. / 4, 3. / 4, 3. / 4, 3. / 4, 3. / 4, 3. / 4},
                   {3. / 4, 1. / 4, 1. / 4, 1. / 4, 1. / 4, 1. / 4},
                   {1. / 4, 1. / 4, 1. / 4, 1. / 4, 3. / 4, 3. / 4},
                   {1. / 4, 3. / 4, 3. / 4, 3. / 4, 1. / 4, 1. / 4},
                   {3. / 4, 3. / 4, 3. / 4, 3. / 4, 1. / 4, 1. / 4},
                   {3. / 4, 3. / 4, 3. / 4, 1. / 4, 3. / 4, 3. / 4}}),
       1.3680112396681947, 1e-12},
      {wraparound_l2_discrepancy, kSquared, halton(0, 1024, 2), 2.9599958508708113e-06, 1e-13},
      {l2_star_discrepancy, kRoot, sobol_net(4, 6), 0.014896763517805481, 1e-12},
      {l2_star_discrepancy, kRoot, Columns(8, {1.0}), 0.012345679012345678, 1e-14},
      {l2_star_discrepancy, kRoot, midpoints(64), 0.004510548978043952, 1e-12},
      {l2_star_discrepancy, kRoot, hammersley(7), 0.011578459675931555, 1e-12},
      {l2_star_discrepancy, kRoot, hammersley(2), 0.2193691634234655, 1e-12},
      {l2_star_discrepancy, kRoot, halton(0, 100, 2), 0.015271739964098575, 1e-12},
      {l2_star_discrepancy, kRoot, halton(1, 1024, 30), 0.0004453449306585631, 1e-12},
      {l2_star_discrepancy, kRoot, sobol_net(4, 5), 0.029045054954510287, 1e-12},
      {l2_star_discrepancy, kRoot, Columns(2, {1.0}), 0.3333333333333333, 1e-14},
      {l2_star_discrepancy, kRoot, halton(0, 64, 3), 0.022114615512120468, 1e-12},
      {l2_star_discrepancy, kRoot, midpoints(1), 0.2886751345948129, 1e-12},
      {l2_star_discrepancy, kRoot, sobol_net(2, 8), 0.0033074703678268075, 1e-12},
      {l2_star_discrepancy, kRoot, halton(0, 1024, 2), 0.0016454954701502552, 1e-12},
      {l2_star_discrepancy, kRoot, halton(1, 1024, 3), 0.0016259171117493185, 1e-12},
      {l2_star_discrepancy, kRoot, halton(1, 1024, 2), 0.0012575311327616, 1e-12},
      {l2_star_discrepancy, kRoot, sobol_net(2, 10), 0.0008679282638502286, 1e-12},
      {l2_star_discrepancy, kRoot, Columns(64, {1.0}), 5.39659527735429e-16, 5.39659527735429e-28},
      {l2_star_discrepancy, kRoot, sobol(1, 2048), 0.000431559398318967, 1e-12},
      {l2_star_discrepancy, kRoot, sobol_net(3, 7), 0.007832540833419372, 1e-12},
      {l2_star_discrepancy, kRoot, halton(0, 10, 3), 0.10678157491385713, 1e-12},
      {l2_star_discrepancy, kRoot, hammersley(5), 0.03851322121004557, 1e-12},
      {l2_star_discrepancy, kRoot, halton(0, 64, 4), 0.023588354415097337, 1e-12},
      {l2_star_discrepancy, kRoot, sobol_net(3, 4), 0.05390478788431378, 1e-12},
      {l2_star_discrepancy, kRoot, halton(1, 1024, 15), 0.0005745852897245563, 1e-12},
      {l2_star_discrepancy, kRoot, halton(0, 16, 2), 0.06824779161021115, 1e-12},
      {l2_star_discrepancy, kRoot, sobol_net(3, 5), 0.02697863216177002, 1e-12},
      {l2_star_discrepancy, kRoot, sobol_net(4, 4), 0.055360908728851244, 1e-12},
      {l2_star_discrepancy, kRoot, sobol_net(2, 4), 0.047766230959700805, 1e-12},
      {l2_star_discrepancy, kRoot, sobol_net(2, 3), 0.10465380884067768, 1e-12},
      {l2_star_discrepancy, kRoot, Columns(4, {1.0}), 0.1111111111111111, 1e-14},
      {l2_star_discrepancy, kRoot, sobol_net(3, 8), 0.003994959986262037, 1e-12},
      {l2_star_discrepancy, kRoot, sobol_net(3, 6), 0.013868227195862197, 1e-12},
      {l2_star_discrepancy, kRoot, hammersley(6), 0.021205108166271126, 1e-12},
      {l2_star_discrepancy, kRoot, halton(1, 4096, 2), 0.000334632760594902, 1e-12},
      {l2_star_discrepancy, kRoot, halton(0, 16, 3), 0.07936440744589907, 1e-12},
      {l2_star_discrepancy, kRoot, sobol_net(2, 5), 0.02400426469988205, 1e-12},
      {l2_star_discrepancy, kRoot, halton(0, 256, 2), 0.0053063698910020855, 1e-12},
      {l2_star_discrepancy, kRoot, sobol(1, 4096), 0.00022387580399340533, 1e-12},
      {l2_star_discrepancy, kRoot, Columns(16, {1.0}), 0.00015241579027587258, 1.5241579027587259e-16},
      {l2_star_discrepancy, kRoot, sobol_net(2, 7), 0.00702978960812672, 1e-12},
      {l2_star_discrepancy, kRoot, midpoints(7), 0.041239304942116126, 1e-12},
      {l2_star_discrepancy, kRoot, sobol_net(2, 14), 6.164538349174788e-05, 2.4658153396699153e-19},
      {l2_star_discrepancy, kRoot, sobol_net(2, 16), 1.5577269807484223e-05, 6.230907922993689e-20},
      {diaphony, kRoot, sobol_net(2, 8), 0.019896478972951052, 1e-12},
      {diaphony, kRoot, sobol_net(2, 10), 0.005156465001415792, 1e-12},
      {diaphony, kRoot, halton(0, 64, 3), 0.1055833872101064, 1e-12},
      {diaphony, kRoot, sobol_net(4, 6), 0.11513140573757716, 1e-12},
      {diaphony, kRoot, sobol_net(2, 6), 0.05779992448680099, 1e-12},
      {diaphony, kRoot, halton(0, 256, 2), 0.01864225898597276, 1e-12},
      {diaphony, kRoot, sobol_net(3, 6), 0.09616554793507959, 1e-12},
      {diaphony, kRoot, halton(0, 64, 2), 0.061954378159151516, 1e-12},
      {diaphony, kRoot, halton(0, 64, 4), 0.11942699272624101, 1e-12},
      {extreme_l2_discrepancy, kSquared, midpoints(7), 0.0017006802721088435, 1e-12},
      {extreme_l2_discrepancy, kSquared, midpoints(64), 2.0345052083333332e-05, 1e-12},
  };
  for (const Case& c : cases) {
    EXPECT_NEAR(std::pow(c.measure(view(c.points)), c.power), c.value, c.tolerance)
        << "case " << &c - cases.data() << ": " << c.points[0].size() << " points in " << c.points.size();
  }
}

}  // namespace
}  // namespace halfslope
