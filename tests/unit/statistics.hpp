// Tests of samples against laws.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

namespace cdem {

/// p of the test of Kolmogorov and Smirnov that u is uniform from 0 to 1 (Stephens' form of the asymptotic series).
inline double KolmogorovSmirnov(std::vector<double> u) {
  std::sort(u.begin(), u.end());
  const double n = static_cast<double>(u.size());
  double most = 0, p = 0;
  for (std::size_t i = 0; i < u.size(); ++i)
    most = std::max({most, u[i] - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - u[i]});
  const double x = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * most;
  if (x < 0.2) return 1;  // the series converges slowly there
  for (int k = 1; k <= 100; ++k) p += (k % 2 ? 2 : -2) * std::exp(-2 * k * k * x * x);
  return std::clamp(p, 0.0, 1.0);
}

/// Maximum-likelihood kappa of Fisher's distribution from the mean resultant length: coth(kappa) - 1/kappa = length.
inline double FisherKappa(double length) {
  double low = 1e-9, high = 1e9;
  for (int i = 0; i < 200; ++i) {
    const double kappa = std::sqrt(low * high);
    (1 / std::tanh(kappa) - 1 / kappa < length ? low : high) = kappa;
  }
  return low;
}

}  // namespace cdem
