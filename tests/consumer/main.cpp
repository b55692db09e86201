// halfslope with a sampler, a heuristic and scenes that it does not know: plain code, and then its own command line.
#include <limits>

#include "experiments/command_line.h"
#include "tests/consumer/r2_sampler.h"
#include "tests/consumer/ridge_scene.h"
#include "tests/consumer/root_heuristic.h"

using namespace halfslope;

namespace {

double ridge(std::span<const double> x, int) { return std::fabs(x[0] - x[1]); }

double torn_ridge(std::span<const double> x, int pixel) {
  return pixel > 0 && x[0] < 0.001 ? std::numeric_limits<double>::quiet_NaN() : ridge(x, pixel);
}

}  // namespace

int main(int argc, char** argv) {
  auto catalogue = Catalogue::built_in();
  catalogue.samplers.add([] { return std::make_unique<R2>(); });
  catalogue.estimators.add({"root", "w_i proportional to the root of c_i p_i", "none"}, root_weight);
  catalogue.add_scene({"one-ridge", "", "|x - y| on the unit square; integral 1/3", "none"},
                      [](const std::string& name, const Catalogue::Resolution&) { return make_ridge(name); });
  catalogue.add_scene({"ridge", "", "|x - y| on the unit square, in each of four pixels", "none"},
                      [](const std::string& name, const Catalogue::Resolution&) {
                        return std::make_unique<FunctionSource>(name, 2, ridge, 1.0 / 3, 2, 2);
                      });
  catalogue.add_scene({"torn-ridge", "", "the ridge, not a number where x < 0.001, but for the first pixel", "none"},
                      [](const std::string& name, const Catalogue::Resolution&) {
                        return std::make_unique<FunctionSource>(name, 2, torn_ridge, 1.0 / 3, 2, 2);
                      });
  catalogue.add_scene({"lost-ridge", "", "the torn ridge, its integral not known either", "none"},
                      [](const std::string& name, const Catalogue::Resolution&) {
                        return std::make_unique<FunctionSource>(name, 2, torn_ridge, std::nullopt, 2, 2);
                      });
  return command_line(argc, argv, catalogue);
}
