// Discs: their statistics on fixed seeds, the part inside a region, files. What of it depends on ranks is run on several
// (mpirun -n 3 cdem_unit --gtest_filter=*Ranks.*).
#include "joints/clip.hpp"
#include "joints/network.hpp"
#include "mesh_make.hpp"
#include "options_fixture.hpp"
#include "statistics.hpp"

#include "core/small.hpp"

#include <fstream>
#include <unistd.h>

namespace cdem {
namespace {

constexpr double kPi = 3.14159265358979323846;
const double kLow[3] = {0, 0, 0}, kHigh[3] = {100, 50, 80};

std::vector<Disc> DrawMany(const JointLaw &law, int n, std::int64_t seed = 1) {
  const DiscSource source(law, seed, "set", kLow, kHigh);
  std::vector<Disc> discs;
  Disc disc;
  for (int i = 0; i < n; ++i)
    if (source.Draw(i, &disc)) discs.push_back(disc);
  return discs;
}

/// Distribution function of a law, written independently of the drawing.
double Below(const DiameterLaw &law, double d) {
  const double *p = law.p;
  if (law.kind == DiameterLaw::kUniform) return (d - p[0]) / (p[1] - p[0]);
  if (law.kind == DiameterLaw::kPower)
    return (std::pow(d, 1 - p[0]) - std::pow(p[1], 1 - p[0])) / (std::pow(p[2], 1 - p[0]) - std::pow(p[1], 1 - p[0]));
  const double var = std::log(1 + p[1] * p[1] / (p[0] * p[0])), mean = std::log(p[0]) - var / 2;
  return 0.5 * std::erfc((mean - std::log(d)) / std::sqrt(2 * var));
}

/// Centres inside the box, so that large discs, which reach it from farther away, do not count for more.
bool Inside(const Disc &disc) {
  bool inside = true;
  for (int k = 0; k < 3; ++k) inside = inside && disc.centre[k] >= kLow[k] && disc.centre[k] <= kHigh[k];
  return inside;
}

TEST(Joints, DiametersFollowTheirLaws) {
  const DiameterLaw laws[] = {{DiameterLaw::kUniform, {2, 5, 0}},     {DiameterLaw::kLogNormal, {3, 1.5, 0}},
                              {DiameterLaw::kLogNormal, {3, 2.5, 0}}, {DiameterLaw::kPower, {2.5, 1, 10}},
                              {DiameterLaw::kPower, {3.5, 0.5, 20}},  {DiameterLaw::kPower, {0, 1, 10}}};
  for (const DiameterLaw &law : laws)
    for (std::int64_t seed = 1; seed <= 3; ++seed) {
      JointLaw joint;
      joint.diameter = law;
      std::vector<double> u;
      double mean = 0, square = 0;
      for (const Disc &disc : DrawMany(joint, law.kind == DiameterLaw::kLogNormal ? 200000 : 20000, seed)) {
        EXPECT_LE(2 * disc.radius, law.Largest() * (1 + 1e-14));
        if (!Inside(disc)) continue;
        u.push_back(Below(law, 2 * disc.radius));
        mean += 2 * disc.radius;
        square += 4 * disc.radius * disc.radius;
      }
      ASSERT_GT(u.size(), 1000u);
      const double p = KolmogorovSmirnov(u), n = static_cast<double>(u.size());
      EXPECT_GT(p, 0.01) << "law " << law.kind << " " << law.p[0] << " seed " << seed;
      const double sd = std::sqrt(law.MeanSquare() - law.Mean() * law.Mean());
      EXPECT_LT(std::fabs(mean / n - law.Mean()), 2.58 * sd / std::sqrt(n)) << law.kind << " " << law.p[0];
      std::printf("law %d (%g, %g, %g), seed %d: %d discs, p = %.3f, mean D %.4f (%.4f), mean D^2 %.3f (%.3f)\n",
                  law.kind, law.p[0], law.p[1], law.p[2], static_cast<int>(seed), static_cast<int>(n), p, mean / n,
                  law.Mean(), square / n, law.MeanSquare());
    }
  const DiameterLaw near_one{DiameterLaw::kPower, {1 + 1e-14, 1, 10}}, one{DiameterLaw::kPower, {1, 1, 10}};
  EXPECT_NEAR(one.Mean(), 9 / std::log(10), 1e-12);
  EXPECT_NEAR(near_one.MeanSquare(), 49.5 / std::log(10), 1e-10);
}

TEST(Joints, DirectionsFollowFisher) {
  for (double kappa : {20.0, 200.0, 2e4}) {
    std::vector<double> p_means, p_kappas;
    for (std::int64_t seed = 1; seed <= 20; ++seed) {
      JointLaw law;
      law.dip = 40, law.dip_direction = 215, law.fisher = kappa;
      law.diameter.p[0] = 1;
      double mean[3], sum[3] = {0, 0, 0}, cross[3], n = 0;
      NormalOf(law.dip, law.dip_direction, mean);
      for (const Disc &disc : DrawMany(law, 5000, seed)) {
        EXPECT_GE(disc.normal[2], 0);
        EXPECT_NEAR(Dot(disc.normal, disc.normal), 1, 1e-14);
        const double sign = Dot(disc.normal, mean) < 0 ? -1 : 1;  // a disc has no upper side
        for (int k = 0; k < 3; ++k) sum[k] += sign * disc.normal[k];
        ++n;
      }
      const double length = std::sqrt(Dot(sum, sum)), found = FisherKappa(length / n);
      Cross(sum, mean, cross);
      const double angle = std::asin(std::sqrt(Dot(cross, cross)) / length);
      p_means.push_back(std::exp(-0.5 * kappa * length * angle * angle));  // chi^2 of two degrees
      p_kappas.push_back(
          std::erfc(std::fabs(found / kappa - 1) * std::sqrt(n) / std::sqrt(2)));  // information 1/kappa^2
      if (seed > 3) continue;
      EXPECT_GT(p_means.back(), 0.01) << kappa << " seed " << seed;
      EXPECT_GT(p_kappas.back(), 0.01) << kappa << " seed " << seed;
      std::printf("kappa %g, seed %d: found %.5g (p = %.3f), mean direction off by %.3f degrees (p = %.3f)\n", kappa,
                  static_cast<int>(seed), found, p_kappas.back(), angle * 180 / kPi, p_means.back());
    }
    // Over many seeds the p themselves are uniform.
    std::printf("kappa %g, 20 seeds: p = %.3f of the kappas, %.3f of the mean directions\n", kappa,
                KolmogorovSmirnov(p_kappas), KolmogorovSmirnov(p_means));
    EXPECT_GT(KolmogorovSmirnov(p_kappas), 0.01);
    EXPECT_GT(KolmogorovSmirnov(p_means), 0.01);
  }
}

TEST(Joints, AnglesFromTheMeanFollowFisher) {
  for (double kappa : {0.0, 1e-6, 0.5, 3.0, 50.0}) {
    JointLaw law;
    law.dip = 0, law.fisher = kappa;  // about the vertical, upward normals fold cos t to |cos t|
    law.diameter.p[0] = 1;
    std::vector<double> u, turn;
    auto below = [&](double c) {  // share with cos t < c
      return kappa < 1e-5 ? 0.5 * (1 + c)
                          : (std::exp(kappa * (c - 1)) - std::exp(-2 * kappa)) / -std::expm1(-2 * kappa);
    };
    for (const Disc &disc : DrawMany(law, 5000)) {
      u.push_back(below(disc.normal[2]) - below(-disc.normal[2]));
      turn.push_back(0.5 + std::atan2(disc.normal[0], disc.normal[1]) / (2 * kPi));
    }
    const double p = KolmogorovSmirnov(u), p_turn = KolmogorovSmirnov(turn);
    EXPECT_GT(p, 0.01) << kappa;
    EXPECT_GT(p_turn, 0.01) << kappa;
    std::printf("kappa %g: p = %.3f of the angles, %.3f of the directions\n", kappa, p, p_turn);
  }
}

TEST(Joints, CentresAreUniform) {
  JointLaw law;
  law.diameter.p[0] = 4;
  std::vector<double> u[3];
  for (const Disc &disc : DrawMany(law, 20000))
    if (Inside(disc))
      for (int k = 0; k < 3; ++k) u[k].push_back((disc.centre[k] - kLow[k]) / (kHigh[k] - kLow[k]));
  for (auto &axis : u) EXPECT_GT(KolmogorovSmirnov(axis), 0.01);
}

TEST(Joints, DependOnSeedNameAndNumberAlone) {
  JointLaw law;
  law.fisher = 10;
  law.diameter = {DiameterLaw::kLogNormal, {3, 2, 0}};
  Disc disc, same, other;
  const DiscSource a(law, 5, "set", kLow, kHigh), b(law, 5, "set", kLow, kHigh), c(law, 5, "sex", kLow, kHigh),
      d(law, 6, "set", kLow, kHigh);
  int n = 0;
  while (!a.Draw(n, &disc)) ++n;
  ASSERT_TRUE(b.Draw(n, &same));
  EXPECT_EQ(disc.centre[0], same.centre[0]);
  EXPECT_EQ(disc.normal[1], same.normal[1]);
  EXPECT_EQ(disc.radius, same.radius);
  c.Draw(n, &other);
  EXPECT_NE(disc.centre[0], other.centre[0]);
  d.Draw(n, &other);
  EXPECT_NE(disc.centre[0], other.centre[0]);
}

TEST(Joints, AnglesAndNormalsAgree) {
  double normal[3], dip, direction;
  NormalOf(30, 90, normal);  // dips to the east: the normal leans east
  EXPECT_NEAR(normal[0], 0.5, 1e-15);
  EXPECT_EQ(normal[1], 0);
  EXPECT_NEAR(normal[2], std::sqrt(0.75), 1e-15);
  NormalOf(90, 180, normal);
  EXPECT_EQ(normal[0], 0);
  EXPECT_EQ(normal[1], -1);
  EXPECT_EQ(normal[2], 0);
  for (double a : {0.5, 30.0, 89.0})
    for (double b : {0.0, 45.0, 135.0, 225.0, 359.0}) {
      NormalOf(a, b, normal);
      AnglesOf(normal, &dip, &direction);
      EXPECT_NEAR(dip, a, 1e-12);
      EXPECT_NEAR(direction, b, 1e-11);
    }
}

TEST(Joints, CircleInPolygon) {
  const double square[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, corner[4][2] = {{0, 0}, {0, 3}, {3, 3}, {3, 0}};
  EXPECT_NEAR(CircleInPolygon(4, square, 2), 4, 1e-14);
  EXPECT_NEAR(CircleInPolygon(4, square, 0.5), kPi / 4, 1e-14);
  EXPECT_NEAR(CircleInPolygon(4, corner, 2), kPi, 1e-14);
  const double r = 1.2, h = std::acos(1 / r);  // four caps beyond the sides
  EXPECT_NEAR(CircleInPolygon(4, square, r), kPi * r * r - 4 * (r * r * h - std::sqrt(r * r - 1)), 1e-13);
  const double far[3][2] = {{5, 5}, {6, 5}, {5, 6}};
  EXPECT_NEAR(CircleInPolygon(3, far, 2), 0, 1e-15);
  const double tangent[4][2] = {{-0.5, -1}, {0.5, -1}, {0.5, -3}, {-0.5, -3}};  // touched by the circle
  EXPECT_NEAR(CircleInPolygon(4, tangent, 1), 0, 1e-15);
}

// The same disc through meshes of all shapes, straight and distorted: its area inside is that inside the box.
TEST(Joints, ClippedAreaIsExact) {
  for (const char *shape : {"hex", "tet", "wedge"})
    for (const char *jitter : {"0", "0.2"}) {
      if (shape[0] != 'h' && jitter[1]) jitter = "0.1";
      Mesh mesh;
      ASSERT_EQ(Make(PETSC_COMM_WORLD,
                     std::string("-mesh box -mesh_box_cells 5,4,6 -mesh_box_size 5,4,6 -mesh_box_shape ") + shape +
                         " -mesh_box_jitter " + jitter,
                     &mesh),
                0);
      Region region;
      ASSERT_EQ(region.Create(mesh, -1), 0);
      EXPECT_NEAR(region.volume, 120, 1e-11);
      struct {
        double centre[3], dip, direction, radius, inside;
      } cases[] = {{{2.4, 2.1, 3.3}, 33, 77, 1.5, kPi * 2.25},  // all inside
                   {{2.5, 2, 3}, 0, 0, 100, 20},                // on a layer of faces, through everything
                   {{2.5, 2, 3.21}, 0, 0, 100, 20},             // between two layers
                   {{2.5, 2, 3}, 90, 0, 100, 30},               // upright
                   {{2.5, 2, 3}, 45, 90, 100, 4 * 5 * std::sqrt(2)},
                   {{0, 0, 3}, 0, 0, 2, kPi},       // a quarter
                   {{2.5, 2, 0}, 0, 0, 1, kPi},     // on the bottom: counts for the cells above
                   {{2.5, 2, 6}, 0, 0, 1, 0},       // on the top: there are none above
                   {{-1, 2, 3}, 10, 270, 0.9, 0}};  // outside
      for (const auto &c : cases) {
        Disc disc;
        std::copy_n(c.centre, 3, disc.centre);
        NormalOf(c.dip, c.direction, disc.normal);
        disc.radius = c.radius;
        std::vector<Disc> discs{disc};
        ASSERT_EQ(region.Clip(&discs), 0);
        EXPECT_NEAR(discs[0].inside, c.inside, 1e-9) << shape << " " << jitter << " dip " << c.dip;
      }
    }
}

class JointsOptions : public OptionsTest {
 protected:
  void SetUp() override {
    OptionsTest::SetUp();
    ASSERT_EQ(
        Make(PETSC_COMM_WORLD, "-mesh box -mesh_box_cells 8,8,8 -mesh_box_size 20,20,20 -mesh_box_jitter 0.2", &mesh),
        0);
  }
  void TearDown() override {
    std::remove(path_.c_str());
    OptionsTest::TearDown();
  }
  PetscErrorCode Run() { return CreateJointSets(mesh, options_, &sets, &faces, &remarks); }
  void Refused(const std::string &options, const std::vector<const char *> &words) {
    ASSERT_EQ(PetscOptionsClear(nullptr), 0);
    Give(options.c_str());
    sets.clear();
    ExpectRefused([&] { return Run(); }, words);
  }
  /// [in] lines: text of the file.
  std::string File(const std::string &lines) {
    std::ofstream(path_) << lines;
    return path_;
  }
  const std::string path_ = testing::TempDir() + "cdem_joints_" + std::to_string(getpid()) + ".txt";
  Mesh mesh;
  std::vector<JointSet> sets;
  std::vector<FaceSet> faces;
  std::vector<std::string> remarks;
};

TEST_F(JointsOptions, P32IsThatWanted) {
  Give(
      "-joints a,b,c -joint_p32 0.8 -joint_dip 50 -joint_dip_direction 10 -joint_fisher 30 -joint_diameter fixed:2 "
      "-joint_b_diameter power:3,1,8 -joint_c_diameter lognormal:2,1");
  ASSERT_EQ(Run(), 0);
  for (const JointSet &set : sets) {
    EXPECT_NEAR(set.volume, 8000, 1e-8);
    double largest = 0, sum = 0;
    for (const Disc &disc : set.discs) {
      largest = std::max(largest, disc.inside);
      sum += disc.inside;
      EXPECT_GT(disc.inside, 0);
      EXPECT_LE(disc.inside, kPi * disc.radius * disc.radius * (1 + 1e-12));
    }
    EXPECT_NEAR(set.P32() * set.volume, sum, 1e-9 * sum);
    EXPECT_LE(std::fabs(sum - 0.8 * 8000), 0.5 * largest * (1 + 1e-12)) << set.name;
    std::printf("%s: %zu discs, P32 %.6f of 0.8\n", set.name.c_str(), set.discs.size(), set.P32());
  }
}

// A count says the density of centres: over many seeds, P32 is count times the mean area.
TEST_F(JointsOptions, CountGivesItsP32) {
  double sum = 0, square = 0, centres = 0;
  const int seeds = 20;
  for (int seed = 1; seed <= seeds; ++seed) {
    ASSERT_EQ(PetscOptionsClear(nullptr), 0);
    Give(("-joints a -joint_count 0.05 -joint_dip 50 -joint_dip_direction 10 -joint_fisher 5 -joint_diameter "
          "uniform:1,5 -seed " +
          std::to_string(seed))
             .c_str());
    sets.clear();
    ASSERT_EQ(Run(), 0);
    sum += sets[0].P32();
    square += sets[0].P32() * sets[0].P32();
    for (const Disc &disc : sets[0].discs)
      centres += std::all_of(disc.centre, disc.centre + 3, [](double x) { return x >= 0 && x <= 20; });
  }
  const double mean = sum / seeds, error = std::sqrt((square / seeds - mean * mean) / (seeds - 1));
  const double expected = 0.05 * kPi / 4 * (1 + 5 + 25) / 3;
  EXPECT_LT(std::fabs(mean - expected), 2.86 * error);  // p = 0.01 of Student's t with 19 degrees
  EXPECT_LT(std::fabs(centres - 0.05 * 8000 * seeds), 2.58 * std::sqrt(0.05 * 8000 * seeds));
  std::printf("count: P32 %.5f +- %.5f, expected %.5f; %g centres inside, expected %g\n", mean, error, expected,
              centres, 0.05 * 8000 * seeds);
}

TEST_F(JointsOptions, YamlGivesTheSameLaws) {
  GiveYaml(
      "joints: [a, b]\n"
      "joint:\n"
      "  a: {p32: 0.2, dip: 30, dip_direction: 40, diameter: 'power:2.5,1,10'}\n"
      "  b:\n"
      "    p32: 0.2\n"
      "    dip: 30\n"
      "    dip_direction: 40\n"
      "    diameter: [power:2.5, 1, 10]\n");
  ASSERT_EQ(ReadJointSets(mesh, options_, &sets), 0);
  for (const JointSet &set : sets) {
    EXPECT_EQ(set.law.diameter.kind, DiameterLaw::kPower);
    EXPECT_EQ(set.law.diameter.p[0], 2.5);
    EXPECT_EQ(set.law.diameter.p[1], 1);
    EXPECT_EQ(set.law.diameter.p[2], 10);
    EXPECT_LT(set.law.fisher, 0);
  }
}

TEST_F(JointsOptions, FileIsReadAndClipped) {
  const std::string path =
      File("# a comment\n10 10 10 30 120 5\n\n  1,2,3,0,0,+1.5e0  # behind\n90 90 90 0 0 1\r\n0, 0, 0, 90, 360, 2\n");
  Give(("-joints a -joint_a_file " + path).c_str());
  ASSERT_EQ(Run(), 0);
  ASSERT_EQ(sets[0].discs.size(), 3u);
  EXPECT_EQ(sets[0].discs[1].radius, 0.75);
  EXPECT_NEAR(sets[0].discs[2].inside, kPi / 4, 1e-12);
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_NE(remarks[0].find("1 of 4 discs"), std::string::npos);
  EXPECT_NEAR(sets[0].disc_area, kPi * (6.25 + 0.5625 + 0.25), 1e-9);
  const std::string table = DiscTable(sets);
  EXPECT_EQ(table.rfind("set,x,y,z,dip,dip_direction,diameter,area_inside\na,10,10,10,", 0), 0u);
}

TEST_F(JointsOptions, BadFilesAreRefused) {
  const std::string good = "1 2 3 30 120 5\n";
  const struct {
    const char *text;
    std::vector<const char *> words;
  } cases[] = {{"1 2 3 30 120\n", {"line 2", "5 numbers", "x y z dip"}},
               {"1 2 3 30 120 5 6\n", {"line 2", "7 numbers"}},
               {"1 2 x3 30 120 5\n", {"line 2", "'x3'"}},
               {"1 2 inf 30 120 5\n", {"line 2", "'inf'"}},
               {"# fine\n\n1 2 3 95 120 5\n", {"line 4", "dip is 95"}},
               {"1 2 3 30 -5 5\n", {"line 2", "direction is -5"}},
               {"1 2 3 30 120 0\n", {"line 2", "diameter is 0"}}};
  for (const auto &c : cases) {
    const std::string path = File(good + c.text);
    std::vector<const char *> words = c.words;
    words.push_back(path.c_str());
    words.push_back("-joint_a_file");
    Refused("-joints a -joint_a_file " + path, words);
  }
  Refused("-joints a -joint_a_file " + File("# nothing\n"), {"holds no line"});
  Refused("-joints a -joint_a_file " + File(""), {"cannot be read or is empty"});
  Refused("-joints a -joint_a_file " + File("90 0 0 0 0 1\n"), {"no disc", "its region", "(20."});
  Refused("-joints a -joint_a_file nowhere.txt", {"nowhere.txt", "-joint_a_file"});
  Refused("-joints a -joint_a_file " + testing::TempDir(), {testing::TempDir().c_str(), "-joint_a_file"});
}

TEST_F(JointsOptions, BadOptionsAreRefused) {
  const std::string set = "-joints a -joint_a_dip 30 -joint_a_dip_direction 40 ", law = "-joint_a_diameter ";
  Refused("-joints a", {"no source", "-joint_a_p32", "-joint_a_file"});
  Refused(set + "-joint_a_p32 1 -joint_a_count 1 -joint_a_diameter fixed:1", {"more than one source"});
  Refused(set + "-joint_a_p32 -1", {"-joint_a_p32", "-1", "above 0"});
  Refused(set + "-joint_a_count 0", {"-joint_a_count", "above 0"});
  Refused("-joints a -joint_a_p32 1", {"-joint_a_dip ", "degrees"});
  Refused("-joints a -joint_a_p32 1 -joint_a_dip 91", {"-joint_a_dip", "91"});
  Refused("-joints a -joint_a_p32 1 -joint_a_dip 30", {"-joint_a_dip_direction", "360"});
  Refused(set + "-joint_a_p32 1", {"-joint_a_diameter", "fixed:d"});
  Refused(set + "-joint_a_p32 1 -joint_a_fisher -3", {"-joint_a_fisher", "-3"});
  Refused(set + "-joint_a_p32 1 -joint_a_diameter fixed:1 -joint_a_within rock", {"-joint_a_within", "rock", "box"});
  for (const auto &[text, word] :
       std::vector<std::pair<const char *, const char *>>{{"5", "lognormal:mean,sd"},
                                                          {"gamma:1,2", "gamma"},
                                                          {"fixed", "fixed:d"},
                                                          {"fixed:0", "above 0"},
                                                          {"fixed:-2", "above 0"},
                                                          {"fixed:1,2", "2 numbers"},
                                                          {"uniform:3,2", "max above min"},
                                                          {"uniform:0,2", "min"},
                                                          {"lognormal:2", "1 number;"},
                                                          {"lognormal:2,0", "above 0"},
                                                          {"power:2,5", "2 numbers"},
                                                          {"power:2.5,10,1", "max above min"},
                                                          {"power:x,1,10", "'x'"},
                                                          {"power:2,1,nan", "'nan'"}})
    Refused(set + "-joint_a_p32 1 " + law + text, {"-joint_a_diameter", text, word});
  Refused(set + "-joint_a_p32 1 " + law + "fixed:1e-5", {"-joint_a_p32", "the most is 1e+09"});
  Refused(set + "-joint_a_count 1e-9 " + law + "fixed:1", {"-joint_a_count", "no disc"});
}

}  // namespace
}  // namespace cdem
