// Random trial stresses against an independent method: the nearest point in the energy norm (associated flow), and
// Koiter's conditions (any flow), by a search over all sets of active planes.
#include "block_law_point.hpp"

namespace cdem {
namespace {

/// n . s <= bound in principal stresses, and its flow direction.
struct Plane {
  Vec3 n;
  double bound;
  Vec3 flow;
};

double Scalar(const Vec3 &a, const Vec3 &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Mohr-Coulomb's six planes and three of the cut-off.
std::vector<Plane> Planes(double c, double phi, double psi, double tension) {
  const double s = std::sin(phi * kDegree), p = std::sin(psi * kDegree);
  std::vector<Plane> planes;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (i == j) continue;
      Plane plane = {{}, 2 * c * std::cos(phi * kDegree), {}};
      plane.n[i] = 1 + s, plane.n[j] = -(1 - s), plane.flow[i] = 1 + p, plane.flow[j] = -(1 - p);
      planes.push_back(plane);
    }
    Plane plane = {{}, tension, {}};
    plane.n[i] = plane.flow[i] = 1;
    planes.push_back(plane);
  }
  return planes;
}

/// Solves the n x n system; false where it has no clear solution.
bool SolveSmall(int n, double a[3][3], double b[3]) {
  for (int i = 0; i < n; ++i) {
    int pivot = i;
    for (int r = i; r < n; ++r)
      if (std::fabs(a[r][i]) > std::fabs(a[pivot][i])) pivot = r;
    std::swap(a[i], a[pivot]);
    std::swap(b[i], b[pivot]);
    if (std::fabs(a[i][i]) < 1e-9) return false;
    for (int r = 0; r < n; ++r) {
      if (r == i) continue;
      const double factor = a[r][i] / a[i][i];
      for (int k = i; k < n; ++k) a[r][k] -= factor * a[i][k];
      b[r] -= factor * b[i];
    }
  }
  for (int i = 0; i < n; ++i) b[i] /= a[i][i];
  return true;
}

double Excess(const std::vector<Plane> &planes, const Vec3 &s) {
  double most = -1e300;
  for (const Plane &p : planes) most = std::max(most, Scalar(p.n, s) - p.bound);
  return most;
}

/// Every set of up to three planes made active: found(stress, multipliers) where it can be solved.
template <class F>
void ForEachSet(const std::vector<Plane> &planes, const Vec3 &trial, F &&found) {
  const int n = static_cast<int>(planes.size());
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j)
      for (int k = j; k < n; ++k) {
        if (j == i && k != j) continue;  // {i}, {i, k}, {i, j, k}
        std::vector<int> set = {i};
        if (j != i) set.push_back(j);
        if (k != j) set.push_back(k);
        double a[3][3], b[3];
        const int size = static_cast<int>(set.size());
        for (int r = 0; r < size; ++r) {
          for (int c = 0; c < size; ++c) a[r][c] = Scalar(planes[set[r]].n, ElasticStress(planes[set[c]].flow)) / kG;
          b[r] = (Scalar(planes[set[r]].n, trial) - planes[set[r]].bound) / kG;
        }
        if (!SolveSmall(size, a, b)) continue;
        Vec3 stress = trial;
        for (int c = 0; c < size; ++c) stress = stress - b[c] * ElasticStress(planes[set[c]].flow);
        found(stress, *std::min_element(b, b + size));
      }
}

Vec3 RandomTrial(std::mt19937_64 &random, double scale) {
  std::uniform_real_distribution<double> entry(-1, 1);
  const double mean = scale * entry(random), size = scale * entry(random) * entry(random);
  Vec3 s;
  for (double &value : s) value = mean + size * entry(random);
  std::sort(s.rbegin(), s.rend());
  return s;
}

struct Case {
  double c, phi, psi, tension;
};

/// Law's return of random trial stresses, in random frames, against the search.
template <class Law>
void ExpectFound(const Case &strength, const std::vector<double> &properties, bool nearest) {
  const std::vector<Plane> planes = Planes(strength.c, strength.phi, strength.psi, strength.tension);
  std::mt19937_64 random(21);
  int yielded = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 trial = RandomTrial(random, 4e7);
    const Frame frame(1 + i % 50);
    PointAt<Law> p(properties);
    const double scale = std::max(Size(trial), 1e6);
    if (!p.Move(Strain(trial), frame)) {
      EXPECT_LE(Excess(planes, trial), 1e-10 * scale);
      continue;
    }
    ++yielded;
    double best = 1e300;
    Vec3 answer{};
    ForEachSet(planes, trial, [&](const Vec3 &stress, double multiplier) {
      if (Excess(planes, stress) > 1e-9 * scale) return;
      if (!nearest && multiplier < -1e-15) return;
      const Vec3 away = trial - stress;
      const double distance = nearest ? Scalar(away, Strain(away)) : Excess(planes, stress);
      if (distance < best) best = distance, answer = stress;
    });
    EXPECT_LT(best, 1e299) << "the search found nothing";
    const Sym exact = frame.Tensor(answer);
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(p.stress[k], exact[k], 1e-10 * scale);
    double s[3];
    PrincipalValues(p.stress.data(), s);
    EXPECT_LE(Excess(planes, {s[0], s[1], s[2]}), 1e-10 * scale);
    if (testing::Test::HasFailure()) {
      std::printf("trial %.17g %.17g %.17g\n", trial[0], trial[1], trial[2]);
      return;
    }
  }
  EXPECT_GT(yielded, 1000);
}

TEST(MohrCoulombLaw, AssociatedReturnIsTheNearestPoint) {
  for (const Case &s : {Case{3e6, 35, 35, 1e6}, Case{3e6, 60, 60, 1e5}, Case{1e6, 10, 10, 5e6}, Case{2e6, 0, 0, 1e6},
                        Case{0, 30, 30, 0}})
    ExpectFound<MohrCoulomb>(s, {s.c, s.phi, s.psi, s.tension}, true);
  ExpectFound<MohrCoulomb>({2e6, 0, 0, 1e20}, {2e6, 0}, true);
  ExpectFound<MohrCoulomb>({2e6, 25, 25, 1e20}, {2e6, 25, 25}, true);
}

TEST(MohrCoulombLaw, AnyReturnObeysKoiter) {
  for (const Case &s : {Case{3e6, 35, 0, 1e6}, Case{3e6, 35, 12, 1e6}, Case{3e6, 60, 20, 1e5}, Case{2e6, 20, 5, 5e5}})
    ExpectFound<MohrCoulomb>(s, {s.c, s.phi, s.psi, s.tension}, false);
}

TEST(BreakageLaw, ResidualReturnObeysKoiter) {
  ExpectFound<Breakage>({1e6, 25, 0, 0}, {3e6, 35, 1e6, 1e6, 25}, false);
  ExpectFound<Breakage>({0, 35, 0, 0}, {3e6, 35, 1e6}, false);
}

TEST(DruckerPragerLaw, AssociatedReturnIsTheNearestPoint) {
  for (double tension : {2e6, 1e5, kPropertyInf})
    for (double cone : {0., 1., 2.}) {
      PointAt<DruckerPrager> p({3e6, 35, 35, tension, cone});
      const double a = p.param[DruckerPrager::kA], k = p.param[DruckerPrager::kK], t = std::min(tension, k / a);
      std::mt19937_64 random(4);
      int yielded = 0;
      for (int i = 0; i < 2000; ++i) {
        const Vec3 trial = RandomTrial(random, 4e7);
        const Frame frame(1 + i % 50);
        std::fill(p.state, p.state + 7, 0);
        const double scale = std::max(Size(trial), 1e6), trace = Trace(trial);
        const Vec3 s = trial - (trace / 3) * Vec3{1, 1, 1};
        const double q = std::sqrt(Scalar(s, s) / 2);
        const bool moved = p.Move(Strain(trial), frame);
        EXPECT_EQ(moved, q > k - a * trace || trace > t);
        if (!moved) continue;
        ++yielded;
        // nearest of: foot on the cone, on the cut-off, the corner; distance I1^2/(9 K) + J2/G
        const double foot = (q + a * trace - k) / (kG + 9 * kK * a * a);
        const double places[3][2] = {{trace - 9 * kK * a * foot, q - kG * foot}, {t, q}, {t, k - a * t}};
        double best = 1e300;
        Vec3 answer{};
        for (const auto &[i1, root] : places) {
          if (root < -1e-9 * scale || root > k - a * i1 + 1e-9 * scale || i1 > t + 1e-9 * scale) continue;
          const double distance = (trace - i1) * (trace - i1) / (9 * kK) + (q - root) * (q - root) / kG;
          if (distance < best) best = distance, answer = (root / q) * s + (i1 / 3) * Vec3{1, 1, 1};
        }
        const Sym exact = frame.Tensor(answer);
        for (int c = 0; c < 6; ++c) EXPECT_NEAR(p.stress[c], exact[c], 1e-10 * scale);
        if (HasFailure()) return;
      }
      EXPECT_GT(yielded, 500);
    }
}

}  // namespace
}  // namespace cdem
