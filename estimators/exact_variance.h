// What an estimator's variance must be, where f and the densities are known in one variable.
#pragma once

#include <optional>

#include "core/integral.h"
#include "estimators/estimator.h"

namespace halfslope {

/// The variance of one round of the estimator at independent points, by adaptive quadrature (relative error about
/// 1e-4 at weights that jump, 1e-9 elsewhere); over k rounds it is a k-th of that. With c_i samples of technique i a
/// round, c = Σ c_k p_k, C_i = c_i / Σ c_k and g = f − Σ_k α_k p_k (estimators/optimal.h)
///
///   folds        Σ_i (1/c_i) ∫ p_i (w_i f / p_i − ∫ w_i f)²
///   one sample   Σ_i C_i ∫ p_i (w_i f / (C_i p_i) − ∫ f)²
///   optimal      ∫ g² / c with A α = b, which is the limit of many rounds
///
/// where p_i = 0 the integrand is 0. Empty for optimal-progressive, whose early rounds have no such form.
std::optional<double> exact_round_variance(const Estimator& estimator, const ExactDensities& densities);

}  // namespace halfslope
