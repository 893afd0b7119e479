// A beam under two end moments, whose exact solution (Saint-Venant) holds for any Poisson's ratio: the work of the moments
// over the exact one shows which element forms lock near incompressibility.
#include "small_body.hpp"

namespace cdem {
namespace {

constexpr double kLength = 8, kDepth = 2, kYoung = 1e10;

/// Work of the moments over the exact M^2 L/(E I), by a static solution.
double Work(const std::string &shape, const std::string &form, double poisson, int cells) {
  Body body;
  const std::string n = std::to_string(cells);
  body.Make("-mesh box -mesh_box_shape " + shape + " -mesh_box_cells " + std::to_string(2 * cells) + "," + n + "," + n +
            " -mesh_box_size 8,2,2");
  body.materials = {MakeMaterial(kYoung, poisson, 2500)};
  body.materials[0].element = form;
  if (form == "spring") body.materials[0].law = BlockLaws::Find(form);
  if (form == "spring")
    body.materials[0].param[SpringBlock::kTension] = body.materials[0].param[SpringBlock::kCohesion] = 1e30;
  body.Build();
  // sigma_xx = 1e5 (z - 1) on both ends: each node its own area's worth
  const double unit[6] = {1e5, 0, 0, 0, 0, 0};
  std::vector<double> load = BoundaryLoads(body.mesh, body.nodes, unit), k = DenseStiffness(body.tables);
  double moment = 0, work = 0;
  for (std::size_t i = 0; i < load.size(); i += 3) {
    const double arm = body.tables.x[i + 2] - 0.5 * kDepth;
    load[i] *= arm;
    load[i + 1] = load[i + 2] = 0;
    moment += 0.5 * std::fabs(load[i] * arm);
  }
  HoldRigidMotions(body.tables, k);
  std::vector<double> u = load;
  EXPECT_TRUE(Factor(k, u.size()));
  SolveFactored(k, u);
  for (std::size_t i = 0; i < u.size(); ++i) work += load[i] * u[i];
  return work / (moment * moment * kLength / (kYoung * std::pow(kDepth, 4) / 12));
}

TEST(Locking, BeamUnderEndMoments) {
  struct Case {
    const char *shape, *form;
    double least, most;  ///< of the work at nu = 0.4999 with 4 cells a depth, over the exact one
  };
  const Case cases[] = {{"hex", "full", 0, 0.7},   {"hex", "bbar", 0.85, 1.05},   {"hex", "onepoint", 0.9, 1.1},
                        {"wedge", "full", 0, 0.7}, {"wedge", "bbar", 0.75, 1.05}, {"tet", "full", 0, 0.3},
                        {"tet", "bbar", 0.6, 1.05}};
  std::printf("    %-6s %-9s work over the exact one: nu = .3 with 4, nu = .4999 with 2 and 4 cells a depth\n", "shape",
              "form");
  for (const Case &c : cases) {
    const double soft = Work(c.shape, c.form, 0.3, 4), coarse = Work(c.shape, c.form, 0.4999, 2),
                 fine = Work(c.shape, c.form, 0.4999, 4);
    std::printf("    %-6s %-9s %.3f   %.3f %.3f\n", c.shape, c.form, soft, coarse, fine);
    SCOPED_TRACE(std::string(c.shape) + " " + c.form);
    EXPECT_GE(fine, c.least);
    EXPECT_LE(fine, c.most);
  }
  std::printf("    hex    spring    %.3f   %.3f %.3f\n", Work("hex", "spring", 0.3, 4),
              Work("hex", "spring", 0.4999, 2), Work("hex", "spring", 0.4999, 4));
}

}  // namespace
}  // namespace cdem
