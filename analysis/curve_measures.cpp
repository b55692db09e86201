#include "analysis/curve_measures.h"

#include "analysis/measure_limits.h"
#include "analysis/pair_correlation.h"
#include "analysis/spectrum.h"
#include "core/error.h"

namespace halfslope {
namespace {

constexpr int kMostBins = 100'000, kMostSize = 1024;

MeasuredValue exactly(double value) { return {value, value, value, "exact"}; }

std::vector<MeasuredValue> exactly(const std::vector<double>& values) {
  std::vector<MeasuredValue> measured;
  for (const double value : values) measured.push_back(exactly(value));
  return measured;
}

/// Of a function of rings.
Measure make_rings(const std::string& subject, const Parameters& parameters, const std::string& name,
                   std::size_t least_count, std::vector<double> (*of_rings)(const PowerSpectrum&)) {
  const int most = parameters.whole(subject, "size", 2, kMostSize) / 2;
  Measure measure;
  measure.refusal = [most, least_count](std::size_t count, std::size_t dims) {
    return count < least_count ? "it needs two points" : spectrum_refusal(count, dims, most);
  };
  measure.rows = [most, name](std::size_t, std::size_t) {
    std::vector<std::string> rows;
    for (int f = 1; f <= most; ++f) rows.push_back(fmt::format("{}:f={}", name, f));
    return rows;
  };
  measure.values = [most, of_rings](const PointSet& points) { return exactly(of_rings(PowerSpectrum(points, most))); };
  return measure;
}

}  // namespace

Measure make_pair_correlation(const std::string& subject, const Parameters& parameters) {
  const int count_of_bins = parameters.whole(subject, "bins", 1, kMostBins);
  const double asked = parameters.number("max");
  if (!(asked >= 0 && asked <= 0.5)) {
    fail(ExitCode::kBadInput, "{}: max must be from 0 to 0.5 (0: the smaller of 0.5 and 10/N^(1/d)), found {}", subject,
         asked);
  }
  const auto bins = [=](std::size_t count, std::size_t dims) {
    return DistanceBins{count_of_bins, asked > 0 ? asked : usual_most_distance(count, dims)};
  };
  Measure measure;
  measure.refusal = [=](std::size_t count, std::size_t dims) {
    return pairs_refusal(count, dims, bins(count, dims).most, count_of_bins);
  };
  measure.rows = [=](std::size_t count, std::size_t dims) {
    std::vector<std::string> rows;
    // Nine digits tell all bins apart, and do not show a centre's rounding.
    for (int k = 0; k < count_of_bins; ++k) rows.push_back(fmt::format("pcf:r={:.9g}", bins(count, dims).centre(k)));
    return rows;
  };
  measure.values = [=](const PointSet& points) {
    return exactly(pair_correlation(points, bins(points.count(), points.dims())));
  };
  return measure;
}

Measure make_spectrum(const std::string& subject, const Parameters& parameters) {
  const int size = parameters.whole(subject, "size", 1, kMostSize), first = -(size / 2);
  Measure measure;
  measure.refusal = [=](std::size_t count, std::size_t dims) { return spectrum_refusal(count, dims, -first); };
  measure.rows = [=](std::size_t, std::size_t) {
    std::vector<std::string> rows;
    for (int ky = first; ky < first + size; ++ky) {
      for (int kx = first; kx < first + size; ++kx) rows.push_back(fmt::format("spectrum:kx={},ky={}", kx, ky));
    }
    return rows;
  };
  measure.values = [=](const PointSet& points) {
    const PowerSpectrum spectrum(points, -first);
    std::vector<MeasuredValue> values;
    for (int ky = first; ky < first + size; ++ky) {
      for (int kx = first; kx < first + size; ++kx) values.push_back(exactly(spectrum.at(kx, ky)));
    }
    return values;
  };
  return measure;
}

Measure make_radial_spectrum(const std::string& subject, const Parameters& parameters) {
  return make_rings(subject, parameters, "radial-spectrum", 1, radial_spectrum);
}

Measure make_anisotropy(const std::string& subject, const Parameters& parameters) {
  return make_rings(subject, parameters, "anisotropy", 2, anisotropy);
}

}  // namespace halfslope
