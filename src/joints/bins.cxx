#include "joints/bins.hpp"

#include <numeric>

namespace cdem {

void PointBins::Fill(const std::vector<double> &points, double reach) {
  const std::size_t n = points.size() / 3;
  if (n == 0) return;
  double longest = 0, product = 1;
  for (int k = 0; k < 3; ++k) {
    lower_[k] = upper_[k] = points[k];
    for (std::size_t i = 0; i < n; ++i) {
      lower_[k] = std::min(lower_[k], points[3 * i + k]);
      upper_[k] = std::max(upper_[k], points[3 * i + k]);
    }
    longest = std::max(longest, upper_[k] - lower_[k]);
  }
  if (longest == 0) longest = 1;
  reach_ = reach + 1e-9 * (longest + reach);  // what rounding may hide
  for (int k = 0; k < 3; ++k) product *= std::max(upper_[k] - lower_[k], 1e-3 * longest);
  const double edge = std::cbrt(product / static_cast<double>(n));
  for (int k = 0; k < 3; ++k) {
    const double length = std::max(upper_[k] - lower_[k], 1e-3 * longest);
    n_[k] = static_cast<int>(std::clamp(length / edge, 1.0, 1024.0));
    edge_[k] = length / n_[k];
  }
  std::vector<std::size_t> bin(n);
  begin_.assign(static_cast<std::size_t>(n_[0]) * n_[1] * n_[2] + 1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t row = Bin(points[3 * i + 1], 1) + static_cast<std::size_t>(n_[1]) * Bin(points[3 * i + 2], 2);
    bin[i] = Bin(points[3 * i], 0) + n_[0] * row;
    ++begin_[bin[i] + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  point_.resize(n);
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < n; ++i) point_[next[bin[i]]++] = i;
}

}  // namespace cdem
