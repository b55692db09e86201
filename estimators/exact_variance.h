// How an estimator's values must spread, where f and the densities are known in one variable.
#pragma once

#include <optional>

#include "analysis/cumulants.h"
#include "core/integral.h"
#include "estimators/estimator.h"

namespace halfslope {

/// The mean, the variance and the further cumulants to the eighth of one round of the estimator at independent points,
/// by adaptive quadrature (relative error of the variance about 1e-4 at weights that jump, 1e-9 elsewhere); k rounds
/// have those of a mean of k. With c_i samples of technique i a round, c = Σ c_k p_k, C_i = c_i / Σ c_k and
/// g = f − Σ_k α_k p_k (estimators/optimal.h), a round is the sum of independent samples that are worth
///
///   folds        w_i f / (c_i p_i)   c_i of each technique i
///   one sample   w_i f / (C_i p_i)   one, of technique i with probability C_i
///   optimal      g / c               c_i of each technique i, and Σ_k α_k, with A α = b: the limit of many rounds
///
/// so the cumulants κ_j of their laws add. The variances are
///
///   folds        Σ_i (1/c_i) ∫ p_i (w_i f / p_i − ∫ w_i f)²
///   one sample   Σ_i C_i ∫ p_i (w_i f / (C_i p_i) − ∫ f)²
///   optimal      ∫ g² / c
///
/// where p_i = 0 the integrand is 0. Empty for optimal-progressive, whose early rounds have no such form.
std::optional<Cumulants> exact_round_cumulants(const Estimator& estimator, const ExactDensities& densities);

}  // namespace halfslope
