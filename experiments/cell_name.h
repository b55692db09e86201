// Which cell a number is of.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace halfslope {

/// A cell as tables and messages name it.
struct CellName {
  std::string scene, estimator, sampler, precision;
  std::uint64_t samples = 0;  ///< N

  bool operator==(const CellName&) const = default;
};

/// Whether the two differ in N at most: points of one line of convergence.
inline bool same_line(const CellName& a, const CellName& b) {
  return a.scene == b.scene && a.estimator == b.estimator && a.sampler == b.sampler && a.precision == b.precision;
}

/// "mis-toy,balance,halton-owen,f64"
inline std::string line_text(const CellName& name) {
  return fmt::format("{},{},{},{}", name.scene, name.estimator, name.sampler, name.precision);
}

/// "mis-toy,balance,halton-owen,f64,64": in messages, and what seeds the cell's bootstrap.
inline std::string to_string(const CellName& name) { return fmt::format("{},{}", line_text(name), name.samples); }

}  // namespace halfslope
