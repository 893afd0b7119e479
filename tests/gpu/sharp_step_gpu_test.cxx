// The sharp critical step on the GPU: its operator against that of the CPU, the step that follows, and that the tables
// which it borrows from the run stay as they are.
#include "../support/quiet_scene.hpp"
#include "../unit/critical_scenes.hpp"
#include "forces/elastic_operator.hpp"
#include "forces/sharp_step.hpp"
#include "forces/start_vector.hpp"

#include <cmath>

namespace cdem {
namespace {

/// Laws, forms and conditions: all that the operator must see as elastic, closed and free.
std::vector<std::string> SharpScenes() {
  std::vector<std::string> scenes = FormScenes();
  for (const char *law : kFailingLaws) scenes.push_back(FailingScene("hex", law));
  for (const char *law : {"elastic", "brittle", "brittle dilating", "softening", "softening dilating"})
    scenes.push_back(BreakingScene("hex", law));
  for (const char *shape : {"tet", "wedge"}) scenes.push_back(BreakingScene(shape));
  scenes.push_back(FailingScene("tet", "mohr_coulomb") + " -block_element bbar");
  scenes.push_back(ReleasingScene("hex"));
  scenes.push_back(QuietScene("hex"));
  scenes.push_back(FailingScene("wedge", "mohr_coulomb") + " -block_young_scatter weibull:3");
  scenes.push_back(BreakingScene("hex") +
                   " -interface_j_kn_scatter uniform:0.5 -interface_j_cohesion_scatter weibull:4");
  return scenes;
}

/// The elastic operators of both machines, and the copy of the tables that the GPU's stands on.
struct Operators {
  std::shared_ptr<DeviceTables> device;
  Mat cpu = nullptr, gpu = nullptr;

  Operators(const Tables &tables, int n_owned_cells) {
    EXPECT_EQ(CopyToCuda(tables, n_owned_cells, &device), PETSC_SUCCESS);
    EXPECT_EQ(CreateElasticOperator(tables, &cpu), PETSC_SUCCESS);
    EXPECT_EQ(CreateCudaElasticOperator(tables, device, &gpu), PETSC_SUCCESS);
  }
  ~Operators() {
    EXPECT_EQ(MatDestroy(&cpu), PETSC_SUCCESS);
    EXPECT_EQ(MatDestroy(&gpu), PETSC_SUCCESS);
  }
};

/// The product with a vector that is random by the nodes' global numbers; this rank's part.
std::vector<double> Product(Mat matrix, const Nodes &nodes, const char *type) {
  Vec x, y;
  EXPECT_EQ(MatCreateVecs(matrix, &x, &y), PETSC_SUCCESS);
  PetscBool right;
  EXPECT_EQ(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(y), &right, type, ""), PETSC_SUCCESS);
  EXPECT_TRUE(right) << "not a vector of type " << type;
  PetscScalar *to;
  PetscInt n;
  EXPECT_EQ(VecGetLocalSize(x, &n), PETSC_SUCCESS);
  EXPECT_EQ(VecGetArrayWrite(x, &to), PETSC_SUCCESS);
  for (PetscInt i = 0; i < n / 3; ++i) RandomComponents(7, 1, nodes.global[i], to + 3 * static_cast<std::ptrdiff_t>(i));
  EXPECT_EQ(VecRestoreArrayWrite(x, &to), PETSC_SUCCESS);
  EXPECT_EQ(MatMult(matrix, x, y), PETSC_SUCCESS);
  const PetscScalar *values;
  EXPECT_EQ(VecGetArrayRead(y, &values), PETSC_SUCCESS);
  const std::vector<double> product(values, values + n);
  EXPECT_EQ(VecRestoreArrayRead(y, &values), PETSC_SUCCESS);
  EXPECT_EQ(VecDestroy(&x), PETSC_SUCCESS);
  EXPECT_EQ(VecDestroy(&y), PETSC_SUCCESS);
  return product;
}

/// max |a - b| / max |b| over all ranks.
double DifferenceOverRanks(MPI_Comm comm, const std::vector<double> &a, const std::vector<double> &b) {
  EXPECT_EQ(a.size(), b.size());
  double most[2] = {0, 0};
  for (std::size_t i = 0; i < a.size(); ++i) {
    most[0] = std::max(most[0], std::fabs(a[i] - b[i]));
    most[1] = std::max(most[1], std::fabs(b[i]));
  }
  EXPECT_EQ(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPI_DOUBLE, MPI_MAX, comm), 0);
  return most[1] > 0 ? most[0] / most[1] : most[0];
}

/// Product, step and their repetition, of the tables of a scene.
void ExpectTheCpus(const Mesh &mesh, const Nodes &nodes, const Tables &tables, const std::vector<Material> &materials,
                   Operators *operators) {
  PetscMPIInt ranks;
  ASSERT_EQ(MPI_Comm_size(tables.comm, &ranks), 0);
  const std::vector<double> on_gpu = Product(operators->gpu, nodes, ranks > 1 ? VECMPICUDA : VECSEQCUDA),
                            again = Product(operators->gpu, nodes, ranks > 1 ? VECMPICUDA : VECSEQCUDA),
                            on_cpu = Product(operators->cpu, nodes, ranks > 1 ? VECMPI : VECSEQ);
  EXPECT_LT(DifferenceOverRanks(tables.comm, on_gpu, on_cpu), 1e-12);
  EXPECT_TRUE(SameBits(on_gpu, again));

  StepBound bound;
  SharpStep cpu, gpu, repeated;
  Mat second;
  ASSERT_PETSC(CreateCudaElasticOperator(tables, operators->device, &second));
  ASSERT_PETSC(ComputeStepBound(tables, materials, &bound));
  ASSERT_PETSC(ComputeSharpStep(mesh, nodes, tables, materials, bound, &cpu));
  ASSERT_PETSC(ComputeSharpStep(mesh, nodes, tables, materials, bound, &gpu, operators->gpu));
  ASSERT_PETSC(ComputeSharpStep(mesh, nodes, tables, materials, bound, &repeated, second));
  ASSERT_PETSC(MatDestroy(&second));
  EXPECT_EQ(gpu.converged, cpu.converged);
  EXPECT_EQ(gpu.dt, cpu.dt);
  EXPECT_NEAR(gpu.theta, cpu.theta, 1e-6 * cpu.theta);
  EXPECT_EQ(gpu.theta, repeated.theta) << "run = run on the GPU";
  EXPECT_EQ(gpu.residual, repeated.residual);
  EXPECT_EQ(gpu.iterations, repeated.iterations);
}

/// [in] comm: of the scene.
void CompareScenes(MPI_Comm comm) {
  for (const std::string &scene : SharpScenes()) {
    SCOPED_TRACE(scene);
    const auto s = SetUpScene(scene + " -ts_max_steps 1 -device cpu", comm);
    ASSERT_NE(s, nullptr);
    Operators operators(s->tables(), static_cast<int>(s->mesh().n_owned));
    ExpectTheCpus(s->mesh(), s->nodes(), s->tables(), s->materials(), &operators);
  }
}

TEST(GpuSharpStep, BeginsWhereTheCpuDoes) {
  StartParts parts;
  parts.key = 11;
  parts.size = 0.01;
  parts.at = {0, 17, 4, 17, 2999};
  parts.added = {1, 0.5, -2, 0.25, 3};
  std::vector<std::int64_t> global(1000);
  std::vector<double> wanted(3000);
  for (std::size_t i = 0; i < global.size(); ++i) {
    global[i] = 5000000000 + 7 * static_cast<std::int64_t>(i);
    RandomComponents(parts.key, parts.size, global[i], &wanted[3 * i]);
  }
  for (std::size_t i = 0; i < parts.at.size(); ++i) wanted[parts.at[i]] += parts.added[i];
  Vec start;
  ASSERT_PETSC(VecCreate(PETSC_COMM_SELF, &start));
  ASSERT_PETSC(VecSetSizes(start, 3000, PETSC_DECIDE));
  ASSERT_PETSC(VecSetType(start, VECCUDA));
  ASSERT_PETSC(FillCudaStart(global, parts, start));
  const PetscScalar *values;
  ASSERT_PETSC(VecGetArrayRead(start, &values));
  EXPECT_TRUE(SameBits({values, values + 3000}, wanted));
  ASSERT_PETSC(VecRestoreArrayRead(start, &values));
  ASSERT_PETSC(VecDestroy(&start));
}

TEST(GpuSharpStep, IsTheCpus) { CompareScenes(PETSC_COMM_SELF); }

// Contrasts of stiffness, springs of many strengths, held nodes: those whose steps are known from dense matrices.
TEST(GpuSharpStep, IsTheCpusInSmallScenes) {
  for (const CriticalScene &scene : kCriticalScenes) {
    SCOPED_TRACE(scene.name);
    Body body;
    MakeScene(scene, &body);
    Operators operators(body.tables, static_cast<int>(body.mesh.n_owned));
    ExpectTheCpus(body.mesh, body.nodes, body.tables, body.materials, &operators);
  }
}

// The run steps on the tables that served the products: its histories must be those of the start.
TEST(GpuSharpStep, LeavesHistoriesAlone) {
  for (const std::string &scene : SharpScenes()) {
    SCOPED_TRACE(scene);
    const auto s = SetUpScene(scene + " -ts_max_steps 1 -device cpu", PETSC_COMM_SELF);
    ASSERT_NE(s, nullptr);
    const Tables &tables = s->tables();
    Vec u, v;
    std::unique_ptr<Backend> backend;
    {
      Operators operators(tables, static_cast<int>(s->mesh().n_owned));
      Product(operators.gpu, s->nodes(), VECSEQCUDA);
      ASSERT_PETSC(CreateCudaBackend(tables, operators.device, {false, "reference"}, &backend));
    }
    ASSERT_PETSC(backend->CreateVecs(&u, &v));
    const double *u_now, *v_now;
    const Histories *history;
    ASSERT_PETSC(backend->Download(&u_now, &v_now, &history));
    const std::vector<double> none(3 * static_cast<std::size_t>(tables.n_owned), 0.0);
    EXPECT_TRUE(SameBits({u_now, u_now + none.size()}, none) && SameBits({v_now, v_now + none.size()}, none));
    const std::vector<ElementHistories> elements = StartElements(tables);
    const std::vector<SpringHistory> springs = StartSprings(tables);
    ASSERT_EQ(history->elements.size(), elements.size());
    ASSERT_EQ(history->springs.size(), springs.size());
    for (std::size_t g = 0; g < elements.size(); ++g) {
      EXPECT_EQ(history->elements[g].state, elements[g].state);
      EXPECT_TRUE(SameBits(history->elements[g].value, elements[g].value));
      EXPECT_TRUE(SameBits(history->elements[g].broken_time, elements[g].broken_time));
    }
    for (std::size_t g = 0; g < springs.size(); ++g) {
      EXPECT_EQ(history->springs[g].state, springs[g].state);
      EXPECT_TRUE(SameBits(history->springs[g].values, springs[g].values));
    }
    ASSERT_PETSC(VecDestroy(&u));
    ASSERT_PETSC(VecDestroy(&v));
  }
}

/// Scenes of a size at which the program itself takes the GPU for it, one with masses that are scaled.
std::vector<std::string> LargeScenes() {
  const std::string box = "-mesh box -mesh_box_cells 40,30,20 -mesh_box_size 40,30,20 -mesh_box_jitter 0.1 ";
  const std::string held = std::string(kRock) + " -gravity 0,0,-9.81 -boundaries zmin -boundary_zmin_fix xyz";
  return {box + held + " -ts_max_steps 50",
          box + held + " -interfaces j -interface_j_on all -interface_j_law elastic -ts_max_steps 50",
          box + held + " -solve relax -relax_ratio 0.5 -relax_kinetic 0.9"};
}

/// The step, and what a run makes of it: as with the bound alone, where no product comes before the run.
void CompareLargeScenes() {
  for (const std::string &scene : LargeScenes()) {
    SCOPED_TRACE(scene);
    const auto cpu = SetUpScene(scene + " -device cpu"), gpu = SetUpScene(scene + " -device cuda");
    ASSERT_TRUE(cpu && gpu);
    EXPECT_TRUE(gpu->sharp().converged);
    EXPECT_EQ(gpu->dt(), cpu->dt());
    if (scene.find("relax") != std::string::npos) continue;
    char step[80];
    std::snprintf(step, sizeof step, " -ts_central_limit bound -ts_central_check warn -ts_dt %.17g", gpu->dt());
    const SceneResult with = RunScene(scene + " -device cuda", PETSC_COMM_WORLD, true),
                      without = RunScene(scene + " -device cuda" + step, PETSC_COMM_WORLD, true);
    EXPECT_GT(with.observed.u_max2, 0);
    EXPECT_TRUE(SameBits(with.u, without.u));
    EXPECT_TRUE(SameBits(with.v, without.v));
  }
}

TEST(GpuSharpStep, OfLargeScenes) { CompareLargeScenes(); }

// Run with mpirun -n 2 and -n 3 (ctest does): the ranks share the GPU, or have one each.
TEST(GpuSharpStepRanks, AreTheCpus) { CompareScenes(PETSC_COMM_WORLD); }
TEST(GpuSharpStepRanks, OfLargeScenes) { CompareLargeScenes(); }

}  // namespace
}  // namespace cdem
