// Sums without rounding.
#include "core/exact_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace cdem {
namespace {

double Sum(const std::vector<double> &terms) {
  ExactSum sum;
  for (double term : terms) sum.Add(term);
  return sum.Value();
}

TEST(ExactSum, KeepsWhatRoundingLoses) {
  EXPECT_EQ(Sum({}), 0);
  EXPECT_EQ(Sum({1e300, 1, -1e300}), 1);
  EXPECT_EQ(Sum({1, 0x1p-60, -1}), 0x1p-60);
  EXPECT_EQ(Sum({-3.5}), -3.5);
  EXPECT_EQ(Sum({std::numeric_limits<double>::denorm_min(), -5e-324, 7e-320}), 7e-320);
  EXPECT_EQ(Sum({std::numeric_limits<double>::max()}), std::numeric_limits<double>::max());
  EXPECT_EQ(Sum({-1e16, -1, -1, -1, -1}), -1e16 - 4);
  EXPECT_TRUE(std::isnan(Sum({1, std::numeric_limits<double>::infinity()})));
}

TEST(ExactSum, DoesNotKnowTheOrder) {
  std::mt19937 random(1);
  std::vector<double> terms;
  for (int i = 0; i < 20000; ++i)
    terms.push_back(std::ldexp(2 * (random() / 4294967296.0) - 1, static_cast<int>(random() % 80) - 40));
  const double sum = Sum(terms);
  long double check = 0;
  for (double term : terms) check += term;
  EXPECT_NEAR(sum, static_cast<double>(check), 1);
  for (int i = 0; i < 5; ++i) {
    std::shuffle(terms.begin(), terms.end(), random);
    EXPECT_EQ(Sum(terms), sum);
  }
}

TEST(ExactSumRanks, DoNotMatter) {
  int rank, size;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  ExactSum part[2];
  std::vector<double> all;
  for (int i = 0; i < 1000; ++i) {
    all.push_back(std::sin(i) * std::ldexp(1, i % 50));
    if (i % size == rank) part[0].Add(all.back()), part[1].Add(-all.back());
  }
  ASSERT_EQ(static_cast<int>(ExactSum::OverRanks(PETSC_COMM_WORLD, part, 2)), 0);
  EXPECT_EQ(part[0].Value(), Sum(all));
  EXPECT_EQ(part[1].Value(), -Sum(all));
}

}  // namespace
}  // namespace cdem
