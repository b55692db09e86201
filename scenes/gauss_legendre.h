// Gauss's rule.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace halfslope {

struct QuadratureNode {
  double x, weight;
};

/// The N nodes and weights on [0, 1]: exact for polynomials up to degree 2N − 1. The zeros of P_N by Newton's method
/// from their asymptotic positions (F. W. J. Olver and others, NIST Handbook of Mathematical Functions, §3.5(v) and
/// §18.16).
template <int N>
std::array<QuadratureNode, N> gauss_legendre() {
  std::array<QuadratureNode, N> nodes;
  for (int i = 0; i < N; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (N + 0.5)), slope = 1;
    for (int step = 0; step < 8; ++step) {
      double p = x, before = 1;  // P₁ and P₀
      for (int n = 2; n <= N; ++n) {
        const double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
        before = p;
        p = next;
      }
      slope = N * (x * p - before) / ((x - 1) * (x + 1));
      x -= p / slope;
    }
    nodes[static_cast<std::size_t>(i)] = {(1 - x) / 2, 1 / ((1 - x) * (1 + x) * slope * slope)};
  }
  return nodes;
}

}  // namespace halfslope
