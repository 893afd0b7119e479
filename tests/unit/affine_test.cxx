// Which elements of a scene go by the form for parallelepipeds.
#include "small_body.hpp"

namespace cdem {
namespace {

/// Elements of a scene by the form for parallelepipeds and by other forms.
std::array<int, 2> Count(const std::string &scene) {
  std::unique_ptr<Simulation> s = SetUpScene(scene + " -ts_max_steps 1 -device cpu", PETSC_COMM_SELF);
  std::array<int, 2> count = {0, 0};
  EXPECT_TRUE(s);
  if (!s) return count;
  for (const ElementTable &t : s->tables().elements)
    count[t.shape == Shape::kHex && t.form == HexForms::Number<HexAffine>() ? 0 : 1] += t.n;
  return count;
}

const std::string kBox = "-mesh box -mesh_box_cells 4,3,2 -block_young 1e9 -block_poisson 0.2 -block_density 2000 ";

TEST(Affine, ElasticBoxesOfFullIntegration) {
  using Counts = std::array<int, 2>;
  EXPECT_EQ(Count(kBox + "-mesh_box_size 4,3,2"), (Counts{24, 0}));
  EXPECT_EQ(Count(kBox + "-mesh_box_size 0.3,0.7,0.1"), (Counts{24, 0})) << "edges that are no round numbers";
  EXPECT_EQ(Count(kBox + "-mesh_box_size 4,3,2 -mesh_box_jitter 0.1"), (Counts{0, 24}));
  for (const char *other : {"-block_element bbar", "-block_element onepoint", "-mesh_box_shape wedge",
                            "-block_law drucker_prager -block_cohesion 1e6 -block_friction 30"})
    EXPECT_EQ(Count(kBox + "-mesh_box_size 4,3,2 " + other)[0], 0) << other;
}

/// A body some of whose vertices have been moved: its elements by form, its forces under a field of displacements.
struct Moved : Body {
  std::array<int, 2> count = {0, 0};
  std::vector<double> u, f;

  explicit Moved(double from) {
    Make("-mesh box -mesh_box_cells 8,2,2 -mesh_box_size 8,2,2");
    Move([from](double x[3]) {
      if (x[0] > from) x[1] += 0.02 * x[0] * x[2];
    });
    Build();
    for (const ElementTable &t : tables.elements) count[t.form == HexForms::Number<HexAffine>() ? 0 : 1] += t.n;
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> entry(-1e-3, 1e-3);
    u.resize(tables.x.size());
    f.assign(u.size(), 0.0);
    for (double &value : u) value = entry(random);
    std::vector<ElementHistories> none = StartElements(tables);
    HostElements(tables, u.data(), nullptr, 0, 0, none, f.data());
  }
};

TEST(Affine, WhereTheyAreMost) {
  using Counts = std::array<int, 2>;
  EXPECT_EQ(Moved(5.5).count, (Counts{20, 12}));
  EXPECT_EQ(Moved(4.5).count, (Counts{16, 16}));
  EXPECT_EQ(Moved(3.5).count, (Counts{0, 32})) << "fewer than half";
}

TEST(Affine, ForcesAreThoseOfFullIntegration) {
  Moved body(5.5);
  Tables plain = body.tables;
  for (ElementTable &t : plain.elements) t.form = HexForms::Number<HexFull>();
  std::vector<double> f(body.u.size(), 0.0);
  std::vector<ElementHistories> none = StartElements(plain);
  HostElements(plain, body.u.data(), nullptr, 0, 0, none, f.data());
  const double size = Largest(f);
  for (std::size_t i = 0; i < f.size(); ++i) f[i] -= body.f[i];
  EXPECT_LT(Largest(f), 1e-14 * size);
  EXPECT_GT(Largest(f), 0) << "both by the same formula";
}

}  // namespace
}  // namespace cdem
