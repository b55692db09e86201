// What measures of spacing and spectra refuse, and why: empty where they do not.
#pragma once

#include <cstddef>
#include <string>

namespace halfslope {

/// What no measure takes more of: steps of its innermost loop, some tens of minutes of one core; and bytes of its own.
inline constexpr double kMostSteps = 4e12, kMostBytes = 8e9;

/// Of what a measure would need; `bytes` beside the points themselves.
std::string too_much(double steps, double bytes);

/// Distances to nearest neighbours.
std::string neighbours_refusal(std::size_t count, std::size_t dims);
/// The largest hole.
std::string dispersion_refusal(std::size_t count, std::size_t dims);
/// Pairs at most `most` apart, in bins.
std::string pairs_refusal(std::size_t count, std::size_t dims, double most, int bins);
/// The spectrum up to a largest frequency.
std::string spectrum_refusal(std::size_t count, std::size_t dims, int most);

}  // namespace halfslope
