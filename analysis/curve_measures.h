// Measures that are curves: pair correlation and spectra, as the menu offers them.
#pragma once

#include <string>

#include "analysis/measures.h"

namespace halfslope {

/// "pcf:bins=…,max=…": rows "pcf:r=0.0125" at the bins' centres. max = 0 stands for the usual distance.
Measure make_pair_correlation(const std::string& subject, const Parameters& parameters);
/// "spectrum:size=…": rows "spectrum:kx=-3,ky=2" for kx and ky from −⌊size/2⌋, `size` of each; kx changes fastest.
Measure make_spectrum(const std::string& subject, const Parameters& parameters);
/// Rows "radial-spectrum:f=5" and "anisotropy:f=5", f = 1 … ⌊size/2⌋.
Measure make_radial_spectrum(const std::string& subject, const Parameters& parameters);
Measure make_anisotropy(const std::string& subject, const Parameters& parameters);

}  // namespace halfslope
