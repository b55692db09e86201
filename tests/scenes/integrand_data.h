// Integrals and variances that were computed outside halfslope: tests/scenes/integrands.json.
#pragma once

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace halfslope {

struct KnownIntegrand {
  std::string id;
  int dims;
  long double integral;                 ///< 25 digits
  std::optional<long double> variance;  ///< empty: infinite
  double variance_error;                ///< relative, 0.5 in the last digit given; of random ones six standard errors
};

inline std::vector<KnownIntegrand> known_integrands() {
  std::ifstream file(HALFSLOPE_SOURCE_DIR "/tests/scenes/integrands.json");
  std::vector<KnownIntegrand> known;
  for (const auto& entry : nlohmann::json::parse(file)) {
    KnownIntegrand one = {entry.at("id"), entry.at("dim"), std::stold(entry.at("exact").get<std::string>()), {}, 0};
    if (!entry.at("variance").is_null()) {
      one.variance = std::stold(entry.at("variance").get<std::string>());
      // Fifteen digits, of Gauss's rule in binary64 two less.
      one.variance_error = entry.at("method") == "gauss-legendre" ? 1e-13 : 5e-15;
      if (entry.contains("se"))
        one.variance_error = 6 * entry.at("se").get<double>() / static_cast<double>(*one.variance);
    }
    known.push_back(one);
  }
  return known;
}

}  // namespace halfslope
