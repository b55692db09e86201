// How good a net is: the quality parameter t.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "analysis/discrepancy.h"
#include "core/generator_matrices.h"

namespace halfslope {

/// What t lies between.
struct TValueBounds {
  int lower, upper;
};

/// t_value of matrices within `most_steps` of its search: where these do not suffice, the t of the fewest dependent
/// rows that were found, which it is at least, and m, which it is at most.
TValueBounds t_value_bounds(const GeneratorMatrices& matrices, int m, double most_steps);

/// m where count is base^m, base ≥ 2.
std::optional<int> exponent_of(std::size_t count, std::uint32_t base);

/// The smallest t for which the first base^m points of these matrices are a (t, m, d)-net: each elementary interval of
/// volume base^(t − m) holds base^t of them. With the first m columns, m − t is the largest number of rows for which
/// the first r_1 rows of the first matrix, the first r_2 of the second, … are independent however they share it (H.
/// Niederreiter, "Point sets and sequences with small discrepancy", Monatsh. Math. 104, 1987, theorem 6.10). In [0, m].
/// A search over those (r_1, …, r_d) by one elimination step each, which goes no further than the fewest dependent rows
/// that it knows: at most (m − t + 1 + d choose d) steps, each O(m) words in base 2 and O(m²) digits in others. A base
/// that is not prime, or m outside [0, digits], aborts.
int t_value(const GeneratorMatrices& matrices, int m);

/// The same of any point set of base^m points, by counting them in the elementary intervals; base ≥ 2. Coordinates
/// count as the next multiple of 2⁻⁵³ above where an interval begins between them and it: so that 1/3, rounded down, is
/// in [1/3, 2/3). A coordinate of 1 counts as just below. A number of points that is no power of the base aborts.
int t_value(const PointSet& points, std::uint32_t base);

/// Why t_value cannot take so many points, or will not: not a power of the base, or too many points times intervals'
/// shapes; empty where it can.
std::string t_value_refusal(std::size_t count, std::size_t dims, std::uint32_t base);

}  // namespace halfslope
