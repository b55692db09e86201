// How smooth an integrand is, as far as rates of convergence ask.
#pragma once

#include <cstdint>

namespace halfslope {

/// Classes of integrands on [0,1]^d that theorems about point sets speak of. "Of one coordinate" is a function of x_j
/// alone, whatever d is.
enum class Regularity : std::uint8_t {
  kSquareIntegrable,  ///< nothing else is known
  kJump,              ///< smooth pieces that meet in surfaces, across which the value jumps
  kAxisJump,          ///< the same, and the surfaces are parallel to the axes
  kKinked,  ///< Lipschitz-continuous, but the mixed derivative ∂^d f/∂x_1…∂x_d is not square-integrable
  kMixedDerivative,      ///< it is
  kSmooth,               ///< mixed derivatives of every order are bounded
  kOneCoordinateJump,    ///< of one coordinate, with jumps
  kOneCoordinateKinked,  ///< of one coordinate, continuous, the derivative with jumps
  kOneCoordinateSmooth,  ///< of one coordinate, smooth
};

}  // namespace halfslope
