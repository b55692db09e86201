// The rows of the integrands' tables, which are one file a family: scenes/integrands_*.cpp.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/integral.h"
#include "core/parameters.h"

namespace halfslope {

/// An integrand with its exact moments.
struct Integrand {
  std::string kernel;  ///< its formula's name; empty: the row's
  int dims = 2;
  std::vector<double> parameters;         ///< of the kernel
  double integral = 0;                    ///< ∫ f over [0,1]^d
  std::optional<double> variance;         ///< of f at a uniform point; infinity where E f² is
  std::vector<Technique> techniques{};    ///< empty: `mean`, with pairs of dimensions
  std::optional<ExactDensities> exact{};  ///< of the techniques
  Regularity regularity = Regularity::kSquareIntegrable;
};

/// What the catalogue says of an analytic scene. Moments are there where the name has no parameters and determines
/// them.
struct IntegrandInfo {
  std::string name, parameters, description, reference;
  std::optional<double> integral{}, variance{};
};

/// A name, and how its integrand is made. `subject`, such as "scene 'ball:d=3'", begins messages of what is wrong with
/// the values (Error(kBadInput)).
struct IntegrandRow {
  IntegrandInfo info;
  std::vector<Parameter> parameters;
  std::function<Integrand(const std::string& subject, const Parameters& values)> make;
};
using IntegrandRows = std::vector<IntegrandRow>;

// The families, in the order of `list scenes`.
IntegrandRows step_integrands();
IntegrandRows ramp_integrands();
IntegrandRows smooth_integrands();
IntegrandRows genz_integrands();
IntegrandRows product_integrands();
IntegrandRows singular_integrands();
IntegrandRows mis_integrands();

/// The integrand, of that class.
inline Integrand of_class(Regularity regularity, Integrand integrand) {
  integrand.regularity = regularity;
  return integrand;
}

/// A row without parameters.
inline IntegrandRow row(const char* name, const char* description, const char* reference, const Integrand& integrand) {
  return {{name, "", description, reference, integrand.integral, integrand.variance},
          {},
          [integrand](const std::string&, const Parameters&) { return integrand; }};
}

/// A row "NAME:d=DIMENSIONS", d from `least` to `most`; `make` is given d.
inline IntegrandRow row_of_dims(const char* name, int least, int most, const char* description, const char* reference,
                                std::function<Integrand(int d)> make) {
  return {{name, "d=DIMENSIONS", description, reference},
          {{"d"}},
          [=](const std::string& subject, const Parameters& values) {
            return make(values.whole(subject, "d", least, most));
          }};
}

/// The variance of an integrand that is 1 on a part p of the cube and 0 elsewhere.
inline double step_variance(double p) { return p * (1 - p); }

namespace papers {
inline constexpr const char* kChristensen =
    "Christensen, Kensler & Kilpatrick, Progressive multi-jittered sample sequences (2018)";
inline constexpr const char* kGenz = "Genz, Testing multidimensional integration routines (1984)";
inline constexpr const char* kOwenSingular = "Owen, Halton sequences avoid the origin (2006)";
inline constexpr const char* kMorokoff = "Morokoff & Caflisch, Quasi-Monte Carlo integration (1995)";
}  // namespace papers

}  // namespace halfslope
