// Block laws with history at a point: closed-form histories, random returns against a search over all faces, edges and
// corners, lanes against double.
#include "block_law_point.hpp"

namespace cdem {
namespace {

constexpr double kC = 3e6, kPhi = 35, kPsi = 12, kT = 1e6;
const double kSin = std::sin(kPhi * kDegree), kCos = std::cos(kPhi * kDegree), kSinPsi = std::sin(kPsi * kDegree);
const double kNPhi = (1 + kSin) / (1 - kSin), kSigmaC = 2 * kC * kCos / (1 - kSin);  // s3 = N s1 - sigma_c

// Mohr-Coulomb: flow directions of s1 - s3, s2 - s3, s1 - s2
Vec3 Flow13(double p) { return {1 + p, 0, -(1 - p)}; }
Vec3 Flow23(double p) { return {0, 1 + p, -(1 - p)}; }
Vec3 Flow12(double p) { return {1 + p, -(1 - p), 0}; }

TEST(MohrCoulombLaw, ReturnsToEveryPlaneEdgeAndCorner) {
  for (double psi : {0.0, kPsi, kPhi}) {
    const double p = std::sin(psi * kDegree);
    const std::vector<double> mc = {kC, kPhi, psi, kT}, open = {kC, kPhi, psi};
    const auto low = [](double s1) { return kNPhi * s1 - kSigmaC; };
    SCOPED_TRACE(psi);
    ExpectReturnsTo<MohrCoulomb>(mc, {0, 0, -kSigmaC}, {Flow13(p)});  // uniaxial compression
    ExpectReturnsTo<MohrCoulomb>(mc, {0, 0, -kSigmaC}, {Flow13(p), Flow23(p)});
    ExpectReturnsTo<MohrCoulomb>(mc, {-5e6, -5e6, low(-5e6)}, {Flow13(p), Flow23(p)});  // triaxial
    ExpectReturnsTo<MohrCoulomb>(mc, {-2e6, -9e6, low(-2e6)}, {Flow13(p)});
    ExpectReturnsTo<MohrCoulomb>(mc, {-1e6, low(-1e6), low(-1e6)}, {Flow13(p), Flow12(p)});
    const Vec3 pull = {1, 0, 0}, pull2 = {0, 1, 0}, pull3 = {0, 0, 1};
    ExpectReturnsTo<MohrCoulomb>(mc, {kT, 0, 0}, {pull});  // uniaxial tension
    ExpectReturnsTo<MohrCoulomb>(mc, {kT, 0.5e6, -1e6}, {pull});
    ExpectReturnsTo<MohrCoulomb>(mc, {kT, kT, -1e6}, {pull, pull2});
    ExpectReturnsTo<MohrCoulomb>(mc, {kT, kT, kT}, {pull, pull2, pull3});
    ExpectReturnsTo<MohrCoulomb>(mc, {kT, -1e6, low(kT)}, {pull, Flow13(p)});
    ExpectReturnsTo<MohrCoulomb>(mc, {kT, kT, low(kT)}, {pull, Flow13(p), pull2, Flow23(p)});
    ExpectReturnsTo<MohrCoulomb>(mc, {kT, low(kT), low(kT)}, {pull, Flow13(p), Flow12(p)});
    const double apex = kC / std::tan(kPhi * kDegree);
    ExpectReturnsTo<MohrCoulomb>(open, {apex, apex, apex}, {pull, pull2, pull3, Flow13(p), Flow12(p)});
  }
}

TEST(MohrCoulombLaw, WithoutFrictionIsTresca) {
  const std::vector<double> tresca = {kC, 0};
  const Vec3 shear = {1, 0, -1};
  for (double mean : {-1e8, 0.0, 1e8})
    ExpectReturnsTo<MohrCoulomb>(tresca, {mean + kC, mean + 0.3 * kC, mean - kC}, {shear});
  ExpectReturnsTo<MohrCoulomb>(tresca, {0, 0, -2 * kC}, {shear, {0, 1, -1}});
  PointAt<MohrCoulomb> fluid({0, 0});
  fluid.Move(Vec3{-1e-3, -2e-3, 5e-4});
  fluid.ExpectStress(-2.5e-3 * kK * Vec3{1, 1, 1}, Frame());
}

TEST(MohrCoulombLaw, PlasticShearStrainIsThatOfPureShear) {
  PointAt<MohrCoulomb> p({kC, 0});
  const double gamma = 5e-3;  // tau = G gamma up to c
  p.Move(Sym{0, 0, 0, gamma / 2, 0, 0});
  EXPECT_NEAR(p.stress[kXY], kC, 1e-12 * kC);
  EXPECT_NEAR(p.state[6], gamma - kC / kG, 1e-12 * gamma);
}

TEST(BlockLaws, RestWithoutStrain) {
  const Sym zero{};
  PointAt<MohrCoulomb> mc({0, 0, 0, 0});
  EXPECT_FALSE(mc.Move(zero));
  PointAt<DruckerPrager> dp({0, 0, 0, 0});
  EXPECT_FALSE(dp.Move(zero));
  PointAt<Breakage> b({0, 30, 0});
  EXPECT_FALSE(b.Move(zero));
  bool tension = true, shear = true;
  Breakage::Judge(b.param, zero.data(), &tension, &shear);
  EXPECT_FALSE(tension || shear);
  for (int k = 0; k < 6; ++k) EXPECT_EQ(mc.stress[k] + dp.stress[k] + b.stress[k], 0);
}

// Drucker-Prager
struct Cone {
  double a, k, flow;
};
Cone ConeOf(int cone, double c, double phi, double psi) {
  const double root3 = std::sqrt(3.0);
  const auto slope = [&](double angle) {
    const double s = std::sin(angle * kDegree);
    return cone == 0   ? 2 * s / (root3 * (3 - s))
           : cone == 1 ? 2 * s / (root3 * (3 + s))
                       : s / (root3 * std::sqrt(3 + s * s));
  };
  const double s = std::sin(phi * kDegree), cosine = std::cos(phi * kDegree);
  const double k = cone == 0   ? 6 * c * cosine / (root3 * (3 - s))
                   : cone == 1 ? 6 * c * cosine / (root3 * (3 + s))
                               : root3 * c * cosine / std::sqrt(3 + s * s);
  return {slope(phi), k, slope(psi)};
}
/// Flow at a stress off the axis: s/(2 sqrt J2) + a_psi 1.
Vec3 ConeFlow(const Vec3 &stress, double flow) {
  const double mean = Trace(stress) / 3;
  const Vec3 s = stress - mean * Vec3{1, 1, 1};
  const double q = std::sqrt((s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) / 2);
  return (0.5 / q) * s + flow * Vec3{1, 1, 1};
}
/// The stress with this I1 and sqrt(J2), of the deviatoric direction of shape.
Vec3 StressOf(double trace, double q, const Vec3 &shape) {
  const Vec3 s = shape - (Trace(shape) / 3) * Vec3{1, 1, 1};
  const double size = std::sqrt((s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) / 2);
  return (q / size) * s + (trace / 3) * Vec3{1, 1, 1};
}

TEST(DruckerPragerLaw, ReturnsToConeCutOffCornerAndApex) {
  const Vec3 all = {1, 1, 1};
  for (int cone : {0, 1, 2})
    for (double psi : {0.0, kPsi, kPhi}) {
      const Cone dp = ConeOf(cone, kC, kPhi, psi);
      const double root3 = std::sqrt(3.0), number = cone;
      const std::vector<double> open = {kC, kPhi, psi, kPropertyInf, number}, cut = {kC, kPhi, psi, kT, number};
      SCOPED_TRACE(testing::Message() << "cone " << cone << " psi " << psi);
      const Vec3 compressed = {0, 0, -root3 * dp.k / (1 - root3 * dp.a)};
      const Vec3 pulled = {root3 * dp.k / (1 + root3 * dp.a), 0, 0};
      ExpectReturnsTo<DruckerPrager>(open, compressed, {ConeFlow(compressed, dp.flow)});
      ExpectReturnsTo<DruckerPrager>(open, pulled, {ConeFlow(pulled, dp.flow)});
      ExpectReturnsTo<DruckerPrager>(cut, {kT, 0, 0}, {all});  // uniaxial tension
      for (const Vec3 &shape : {Vec3{1, 0, -1}, Vec3{1, 1, -2}, Vec3{3, -1, 0.5}}) {
        const Vec3 confined = StressOf(-1e7, dp.k + dp.a * 1e7, shape);
        ExpectReturnsTo<DruckerPrager>(cut, confined, {ConeFlow(confined, dp.flow)});
        const Vec3 corner = StressOf(kT, dp.k - dp.a * kT, shape);
        ExpectReturnsTo<DruckerPrager>(cut, corner, {ConeFlow(corner, dp.flow), all});
        const Vec3 below = StressOf(kT, 0.5 * (dp.k - dp.a * kT), shape);
        ExpectReturnsTo<DruckerPrager>(cut, below, {all});
        const Vec3 apex = (dp.k / dp.a / 3) * all;  // any deviator flows there, with dilation to match
        ExpectReturnsTo<DruckerPrager>(open, apex, {shape + (2 - Trace(shape) / 3) * all, all});
      }
      ExpectReturnsTo<DruckerPrager>(open, (dp.k / dp.a / 3) * all, {all});
    }
}

TEST(DruckerPragerLaw, OuterConeMeetsMohrCoulombInCompressionAndMiddleInExtension) {
  const Cone outer = ConeOf(0, kC, kPhi, 0), middle = ConeOf(1, kC, kPhi, 0);
  const double root3 = std::sqrt(3.0), confining = 4e6;
  const double high = (root3 * outer.k + (1 + 2 * root3 * outer.a) * confining) / (1 - root3 * outer.a);
  EXPECT_NEAR(high, kSigmaC + kNPhi * confining, 1e-12 * high);
  const double pulled = root3 * middle.k / (1 + root3 * middle.a);
  EXPECT_NEAR(pulled, 2 * kC * kCos / (1 + kSin), 1e-12 * pulled);
}

TEST(DruckerPragerLaw, ShearAtFixedVolumeDilatesAgainstItsPressure) {
  const Cone dp = ConeOf(0, kC, kPhi, kPsi);
  PointAt<DruckerPrager> p({kC, kPhi, kPsi});
  double reached = 0;
  for (double gamma : {2e-4, 1e-3, 2e-3, 6e-3}) {  // engineering shear
    p.Move(Sym{0, 0, 0, gamma / 2, 0, 0});
    const double slip = std::max(0.0, (kG * gamma - dp.k) / (kG + 9 * kK * dp.a * dp.flow));
    EXPECT_NEAR(p.stress[kXY], kG * (gamma - slip), 1e-12 * kG * gamma);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(p.stress[i], -3 * kK * dp.flow * slip, 1e-12 * kG * gamma);
    EXPECT_NEAR(p.state[6], slip, 1e-12 * gamma);
    reached = gamma;
  }
  // back: elastic over twice the strength that the pressure gives, then the other way
  const double tau = p.stress[kXY], slip = p.state[6], back = 1.5 * tau / kG;
  EXPECT_FALSE(p.Move(Sym{0, 0, 0, (reached - back) / 2, 0, 0}));
  EXPECT_NEAR(p.stress[kXY], tau - kG * back, 1e-11 * tau);
  EXPECT_TRUE(p.Move(Sym{0, 0, 0, (reached - 3 * tau / kG) / 2, 0, 0}));
  const double more = tau / (kG + 9 * kK * dp.a * dp.flow);
  EXPECT_NEAR(p.stress[kXY], -(2 * tau - kG * more), 1e-11 * tau);
  EXPECT_NEAR(p.state[6], slip + more, 1e-11 * slip);
}

TEST(DruckerPragerLaw, WithoutFrictionIsMises) {
  PointAt<DruckerPrager> p({kC, 0});
  const double k = 6 * kC / (std::sqrt(3.0) * 3);
  for (double mean : {-1e-2, 0.0, 1e-2}) {
    p.Move(Sym{mean, mean, mean, 4e-3, 0, 0});
    EXPECT_NEAR(p.stress[kXY], k, 1e-10 * k);
    EXPECT_NEAR(p.stress[kXX], 3 * kK * mean, 1e-12 * kK);
  }
}

TEST(DruckerPragerLaw, SoftensWithThePlasticShearStrainBefore) {
  const double gf = 400, size = 0.5, residual = 1e6, residual_phi = 20, tension = 5e5;
  const Cone peak = ConeOf(2, kC, kPhi, 0), left = ConeOf(2, residual, residual_phi, 0);
  PointAt<DruckerPrager> p({kC, kPhi, 0, tension, 2, gf, residual, residual_phi, 1e5}, size);
  const double gone = 2 * gf / (size * (peak.k - left.k));  // plastic shear strain of residual strength
  double before = 0, work = 0;
  const int steps = 4000;
  for (int i = 1; i <= steps; ++i) {
    const double gamma = 1.5 * (gone + peak.k / kG) * i / steps;
    p.Move(Sym{0, 0, 0, gamma / 2, 0, 0});
    const double strength = peak.k - (peak.k - left.k) * std::min(1.0, before / gone);
    const double trial = kG * (gamma - before);
    EXPECT_NEAR(p.stress[kXY], std::min(trial, strength), 1e-12 * kG * gamma);
    EXPECT_NEAR(p.state[6], before + std::max(0.0, trial - strength) / kG, 1e-12 * gamma);
    work += (strength - left.k) * (p.state[6] - before);
    before = p.state[6];
    if (HasFailure()) return;
  }
  EXPECT_NEAR(p.stress[kXY], left.k, 1e-9 * kC);
  EXPECT_NEAR(work * size, gf, 1e-2 * gf) << "energy above the residual strength, up to the step";
  const double pull = 1e-3, now = 1e5;  // the cut-off too is the residual one
  p.Move(Sym{pull, pull, pull, p.state[kXY], 0, 0});
  EXPECT_NEAR(p.stress[kXX] + p.stress[kYY] + p.stress[kZZ], now, 1e-10 * kK * pull);
}

// Breakage
TEST(BreakageLaw, JudgesTensionAndShear) {
  PointAt<Breakage> p({kC, kPhi, kT});
  const auto judged = [&](const Vec3 &s) {
    int found = -1;
    for (unsigned seed : {0u, 3u, 4u}) {
      bool tension, shear;
      const Sym mean = Frame(seed).Tensor(s);
      Breakage::Judge(p.param, mean.data(), &tension, &shear);
      const int now = tension ? 1 : shear ? 2 : 0;
      EXPECT_TRUE(found == -1 || found == now);
      found = now;
    }
    return found;
  };
  const double near = 1e-9;
  EXPECT_EQ(judged({(1 - near) * kT, 0, 0}), 0);
  EXPECT_EQ(judged({(1 + near) * kT, 0, 0}), 1);
  EXPECT_EQ(judged({(1 + near) * kT, kT / 2, -1e5}), 1);
  EXPECT_EQ(judged({0, 0, -(1 - near) * kSigmaC}), 0);
  EXPECT_EQ(judged({0, 0, -(1 + near) * kSigmaC}), 2);
  EXPECT_EQ(judged({-1e6, -2e6, kNPhi * -1e6 - (1 - near) * kSigmaC}), 0);
  EXPECT_EQ(judged({-1e6, -2e6, kNPhi * -1e6 - (1 + near) * kSigmaC}), 2);
  EXPECT_EQ(judged({-1e9, -1e9, -1e9}), 0);
}

TEST(BreakageLaw, BrokenPointsHaveResidualStrength) {
  const double residual = 2e5, phi = 25, s = std::sin(phi * kDegree);
  const double n = (1 + s) / (1 - s), left = 2 * residual * std::cos(phi * kDegree) / (1 - s);
  const std::vector<double> p = {kC, kPhi, kT, residual, phi};
  ExpectReturnsTo<Breakage>(p, {0, 0, -left}, {Flow13(0), Flow23(0)});
  ExpectReturnsTo<Breakage>(p, {-1e6, -2e6, -n * 1e6 - left}, {Flow13(0)});
  ExpectReturnsTo<Breakage>(p, {0, -1e4, -left / 2}, {{1, 0, 0}});
  ExpectReturnsTo<Breakage>(p, {0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, kT);
  ExpectReturnsTo<Breakage>({kC, kPhi, kT}, {-1e6, -2e6, -kNPhi * 1e6}, {Flow13(0)});  // residual c = 0, phi as before
}

TEST(BlockLaws, LanesEqualDoubleToTheLastBit) {
  ExpectLanesEqualDouble<MohrCoulomb>({{kC, kPhi, kPsi, kT}, {kC, kPhi}, {kC, 0}, {0, 30, 30, 0}}, 3000);
  ExpectLanesEqualDouble<DruckerPrager>(
      {{kC, kPhi, kPsi, kT, 0}, {kC, kPhi, 0, kPropertyInf, 1}, {kC, 0}, {kC, kPhi, 0, kT, 2, 400, 1e5, 20}}, 3000);
  ExpectLanesEqualDouble<Breakage>({{kC, kPhi, kT}, {kC, kPhi, kT, 1e6, 10}, {kC, kPhi, 0, 0, 0}}, 2000);
}

TEST(BreakageLaw, JudgesLanesAsDouble) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> entry(-1, 1);
  PointAt<Breakage> p({kC, kPhi, kT});
  Lanes param[kMaxParams];
  for (int i = 0; i < kMaxParams; ++i) param[i] = Lanes{} + p.param[i];
  int seen[3] = {0, 0, 0};
  for (int round = 0; round < 1000; ++round) {
    Lanes mean[6];
    for (int l = 0; l < kLanes; ++l) {
      const double size = 2e7 * entry(random) * entry(random), middle = -1e7 * std::fabs(entry(random));
      for (int k = 0; k < 6; ++k) mean[k][l] = size * entry(random) + (k < 3 ? middle : 0);
    }
    MaskOf<Lanes> tension, shear;
    Breakage::Judge(param, mean, &tension, &shear);
    for (int l = 0; l < kLanes; ++l) {
      bool t, s;
      const double one[6] = {mean[0][l], mean[1][l], mean[2][l], mean[3][l], mean[4][l], mean[5][l]};
      Breakage::Judge(p.param, one, &t, &s);
      EXPECT_EQ(t, tension[l] != 0);
      EXPECT_EQ(s, shear[l] != 0);
      ++seen[t ? 1 : s ? 2 : 0];
    }
  }
  for (int count : seen) EXPECT_GT(count, 200);
}

}  // namespace
}  // namespace cdem
