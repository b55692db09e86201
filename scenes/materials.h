// Indices of refraction by name.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halfslope {

/// The complex index of refraction η + ik of a metal, in linear sRGB.
struct Metal {
  Eigen::Array3d eta, k;
};

/// By Mitsuba's names (Ag, Al, Au, Cu, …): its measured spectra against the CIE 1931 observer, as B. Bitterli's
/// Tungsten renderer publishes them (ComplexIorData). Names whose spectra come to negative numbers that way (AlAs,
/// AlSb, …) are left out.
std::optional<Metal> find_metal(std::string_view name);
std::vector<std::string> metal_names();

/// The index of refraction of a dielectric at 589 nm by Mitsuba's names (bk7, air, water, diamond, …), in any case;
/// from Hecht, Optics, 4th edition.
std::optional<double> find_ior(std::string_view name);
std::vector<std::string> ior_names();

}  // namespace halfslope
