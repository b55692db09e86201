// The ways to make an interval of log μ, μ the mean of non-negative values such as squared errors: a menu.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/bootstrap.h"
#include "analysis/intervals.h"

namespace halfslope {

/// To add a method: a name here, a row in interval_methods(), a case in both log_mean_interval; selfcheck then measures
/// its coverage like the others'.
enum class IntervalMethod : std::uint8_t { kBootstrapT, kChi2, kDelta, kBca, kReciprocalT };

struct IntervalMethodInfo {
  IntervalMethod method;
  std::string_view name, description, reference;
};

/// All of them, the default first.
std::span<const IntervalMethodInfo> interval_methods();

std::string_view to_string(IntervalMethod method);
/// Empty where no method has this name.
std::optional<IntervalMethod> parse_interval_method(std::string_view name);

/// Of log μ from n values:
///
///   bootstrap-t  log_mean_bootstrap_t: log half-widths × (1 + 1.5/n)
///   chi2         log_mean_chi2
///   delta        log_mean_t
///   bca          log_mean_bca
///   reciprocal-t log_mean_reciprocal_t
///
/// `seed` is of the resamples; chi2 and delta draw none. Empty below two values, and where all are equal or one is
/// negative or not finite.
std::optional<Interval> log_mean_interval(IntervalMethod method, std::span<const double> values, std::uint64_t seed,
                                          double level = 0.95);

/// Those of several methods, from one set of resamples; each is what it would be alone.
std::vector<std::optional<Interval>> log_mean_intervals(std::span<const IntervalMethod> methods,
                                                        std::span<const double> values, std::uint64_t seed,
                                                        double level = 0.95);

/// The same from moments alone, for more values than are kept: chi2 for chi2 and delta for the others, which thousands
/// of values make no difference to.
std::optional<Interval> log_mean_interval(IntervalMethod method, const Moments& moments, double level = 0.95);

/// Of log μ by a scaled chi-squared law: were the n values' mean m = μ χ²_ν/ν, it had the relative variance 2/ν. The
/// measured one is s²/(n m²), so ν = 2 n m²/s² (F. E. Satterthwaite, "An approximate distribution of estimates of
/// variance components", Biometrics Bulletin 2(6), 1946), and μ lies in [ν m/χ²_{ν,(1+level)/2}, ν
/// m/χ²_{ν,(1−level)/2}]. For squared normal errors ν tends to their number, n · P where the P integrals of an image
/// are independent; the plain ν = n would be exact for one normal error a value and nothing else: for an image it is √P
/// too wide. Empty as log_mean_t.
std::optional<Interval> log_mean_chi2(const Moments& moments, double level = 0.95);

/// Of log μ by the bootstrap's percentiles, bias-corrected and accelerated (B. Efron, "Better bootstrap confidence
/// intervals", J. Am. Stat. Assoc. 82, 1987): with m the values' mean, z_0 = Φ⁻¹(share of the B = 999 resampled means
/// below m, equal ones by half), a = Σ(x − m)³ / (6 (Σ(x − m)²)^{3/2}) and z = Φ⁻¹ of a tail, each end is the quantile
/// Φ(z_0 + (z_0 + z)/(1 − a (z_0 + z))) of log m*, between ranks on a line. A quantile beyond the outermost resample is
/// that resample: with few or heavy-tailed values the interval is then too short. Resamples of equal values have a mean
/// like any other. Empty where no resample or every one lies below m, or an end is a resample of zeros.
std::optional<Interval> log_mean_bca(const MeanBootstrap& bootstrap, double level = 0.95);

/// Of log μ by a bootstrap-t of 1/μ instead: with m and s the values' mean and standard deviation, each of B = 999
/// resamples gives T* = (1/m − 1/m*)/se*, se* = s*/(√n m*²), and
///   1/μ in [1/m + w se T*_(25), 1/m + w se T*_(975)],   se = s/(√n m²),   w = 1 + (1.5 + γ²/2)/n,
/// γ the values' skewness m3/m2^{3/2}. A resample that misses the large values has a small mean and a smaller spread
/// still; on this scale its T* is what it should be where log m* − log m overstates it. The two corrections of w are
/// empirical: γ² is what heavy tails show of themselves. Measured, it covers more often than log_mean_bootstrap_t on
/// every law but the uniform one (docs/errors.md). Where the values do not bound μ from above, the upper end is
/// infinite. Resamples of equal values count as there.
std::optional<Interval> log_mean_reciprocal_t(const MeanBootstrap& bootstrap, double level = 0.95);

}  // namespace halfslope
