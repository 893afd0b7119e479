#include "forces/sharp_step.hpp"

#include "core/events.hpp"
#include "forces/elastic_operator.hpp"
#include "forces/start_vector.hpp"

#include <petscksp.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cdem {

double RitzResidual2(const std::vector<double> &before, const std::vector<double> &now) {
  const double theta = before.back();
  double product = (now.back() - theta) * (theta - now.front());
  // interlaced, every further factor is at most 1; where values coincide it is taken as 1, which errs upwards
  for (std::size_t i = 1; i + 1 < now.size(); ++i) {
    const double low = theta - now[i], high = theta - before[i - 1];
    if (high > 0 && low < high) product *= std::max(low, 0.0) / high;
  }
  return std::max(product, 0.0);
}

namespace {

constexpr int kCheckEvery = 10;      ///< iterations from one check to the next
constexpr int kMaxIterations = 300;  ///< then the bound is taken
constexpr double kTolerance = 0.01;  ///< residual over theta
constexpr double kShift = 0.01;  ///< of the growth by one product: makes the matrix definite; no Ritz vector changes

/// Lanczos steps after which a mode that only the random part of the start vector holds, one in n, is seen if its
/// eigenvalue is kTolerance above the others: Chebyshev's polynomials have it grown by exp(2 k sqrt(kTolerance)) by then,
/// from 1/sqrt(n), with a factor of 10 to spare.
int LeastIterations(double n) { return static_cast<int>(std::log(10 * std::sqrt(n)) / (2 * std::sqrt(kTolerance))); }

/// What the test of convergence remembers.
struct Watch {
  double shift;
  int least;  // iterations before any check counts as the last
  SharpStep *sharp;
  std::vector<double> before = {};  // Ritz values one iteration before a check
  int good = 0;                     // checks passed in a row
  double first = 0;                 // norm of what CG begins with
};

PetscErrorCode RitzValues(KSP ksp, PetscInt n, std::vector<double> *values) {
  PetscFunctionBeginUser;
  std::vector<double> imaginary(n);
  PetscInt found = 0;
  values->resize(n);
  PetscCall(KSPComputeEigenvalues(ksp, n, values->data(), imaginary.data(), &found));
  values->resize(found);
  std::sort(values->begin(), values->end());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// PETSc asks after every iteration; what it solves does not matter, only the Ritz values on the way.
PetscErrorCode Converged(KSP ksp, PetscInt iteration, PetscReal norm, KSPConvergedReason *reason, void *context) {
  PetscFunctionBeginUser;
  auto &watch = *static_cast<Watch *>(context);
  *reason = KSP_CONVERGED_ITERATING;
  if (iteration == 0) {
    watch.first = norm;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  SharpStep &sharp = *watch.sharp;
  sharp.iterations = static_cast<int>(iteration);
  if (norm <= 1e-100 * watch.first) {  // nothing is left of the start vector, many times over: all values are exact
    std::vector<double> all;
    PetscCall(RitzValues(ksp, iteration, &all));
    sharp.theta = all.back() - watch.shift;
    sharp.residual = 0;
    watch.good = 2;
    *reason = KSP_CONVERGED_HAPPY_BREAKDOWN;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if ((iteration + 1) % kCheckEvery == 0) PetscCall(RitzValues(ksp, iteration, &watch.before));
  if (iteration % kCheckEvery != 0) PetscFunctionReturn(PETSC_SUCCESS);
  std::vector<double> now;
  PetscCall(RitzValues(ksp, iteration, &now));
  sharp.theta = watch.before.back() - watch.shift;
  sharp.residual = std::sqrt(RitzResidual2(watch.before, now));
  watch.good = sharp.residual < kTolerance * sharp.theta ? watch.good + 1 : 0;
  if (watch.good >= 2 && iteration >= watch.least) *reason = KSP_CONVERGED_HAPPY_BREAKDOWN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Random, with the modes of the element and of the node that give the bound, each as long as the random part.
PetscErrorCode StartVector(const Mesh &mesh, const Nodes &nodes, const Tables &tables,
                           const std::vector<Material> &materials, const StepBound &bound, Vec start) {
  PetscFunctionBeginUser;
  // the first by global number, whatever the partition
  std::int64_t first[2] = {std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::max()};
  for (std::size_t g = 0; g < tables.elements.size(); ++g)
    if (bound.element[g] >= 0)
      first[0] = std::min<std::int64_t>(first[0], mesh.cell_global[tables.elements[g].cell[bound.element[g]]]);
  if (bound.node >= 0) first[1] = nodes.global[bound.node];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, first, 2, MPI_INT64_T, MPI_MIN, tables.comm));

  StartParts parts;
  parts.key = KeyNumber("start of the sharp critical step");
  parts.size = std::sqrt(1.0 / static_cast<double>(nodes.n_global));  // three components of variance 1/3
  const auto add = [&](int node, const double mode[3]) {
    for (int k = 0; node < tables.n_owned && k < 3; ++k) {
      parts.at.push_back(3ll * node + k);
      parts.added.push_back(mode[k]);
    }
  };
  for (const ElementTable &t : tables.elements)
    for (int e = 0; e < t.n; ++e) {
      if (mesh.cell_global[t.cell[e]] != first[0]) continue;
      double mode[kMaxCorners][3];
      ElementMode(tables, materials, t, e, mode);
      for (int a = 0; a < t.corners; ++a) add(t.Node(a, e), mode[a]);
    }
  if (bound.node >= 0 && nodes.global[bound.node] == first[1]) {
    double mode[3];
    SpringMode(tables, bound.node, mode);
    add(bound.node, mode);
  }
#ifdef CDEM_HAVE_CUDA
  PetscBool on_gpu;
  PetscCall(
      PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(start), &on_gpu, VECSEQCUDA, VECMPICUDA, VECCUDA, ""));
  if (on_gpu) {
    PetscCall(FillCudaStart(nodes.global, parts, start));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
#endif
  PetscScalar *x;
  PetscCall(VecGetArrayWrite(start, &x));
  for (int i = 0; i < tables.n_owned; ++i)
    RandomComponents(parts.key, parts.size, nodes.global[i], x + 3 * static_cast<std::ptrdiff_t>(i));
  for (std::size_t i = 0; i < parts.at.size(); ++i) x[parts.at[i]] += parts.added[i];
  PetscCall(VecRestoreArrayWrite(start, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// A CG solve, of which only the Lanczos process inside is of use.
PetscErrorCode Iterate(Mat matrix, Vec start, double shift, SharpStep *sharp) {
  PetscFunctionBeginUser;
  KSP ksp;
  PC pc;
  Vec solution;
  PetscInt n;
  PetscCall(VecGetSize(start, &n));
  Watch watch{shift, LeastIterations(static_cast<double>(n)), sharp};
  PetscCall(KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(matrix)), &ksp));
  PetscCall(KSPSetOperators(ksp, matrix, matrix));
  PetscCall(KSPSetType(ksp, KSPCG));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCNONE));
  PetscCall(KSPSetComputeEigenvalues(ksp, PETSC_TRUE));
  PetscCall(KSPSetTolerances(ksp, 0, 0, 1e300, kMaxIterations));
  PetscCall(KSPSetConvergenceTest(ksp, Converged, &watch, nullptr));
  PetscCall(VecDuplicate(start, &solution));
  PetscCall(KSPSolve(ksp, start, solution));
  sharp->converged = watch.good >= 2;
  PetscCall(VecDestroy(&solution));
  PetscCall(KSPDestroy(&ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

double RoundedStep(double step) {
  int exponent;
  const double mantissa = std::frexp(step, &exponent);
  return std::ldexp(std::floor(std::ldexp(mantissa, 10)), exponent - 10);
}

PetscErrorCode ComputeSharpStep(const Mesh &mesh, const Nodes &nodes, const Tables &tables,
                                const std::vector<Material> &materials, const StepBound &bound, SharpStep *sharp,
                                Mat matrix) {
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(events.bound, nullptr, nullptr, nullptr, nullptr));
  *sharp = SharpStep();
  sharp->w2 = bound.w2();
  sharp->dt = bound.dt;
  Vec start;
  if (matrix)
    PetscCall(PetscObjectReference(reinterpret_cast<PetscObject>(matrix)));
  else
    PetscCall(CreateElasticOperator(tables, &matrix));
  PetscCall(MatCreateVecs(matrix, &start, nullptr));
  PetscCall(StartVector(mesh, nodes, tables, materials, bound, start));
  // stiffness of the free components at all?
  Vec image;
  PetscReal size, before;
  PetscCall(VecDuplicate(start, &image));
  PetscCall(MatMult(matrix, start, image));
  PetscCall(VecNorm(start, NORM_2, &before));
  PetscCall(VecNorm(image, NORM_2, &size));
  PetscCall(VecDestroy(&start));  // its memory serves the iteration
  if (size > 0) {
    const double shift = kShift * size / before;
    PetscCall(MatShift(matrix, shift));
    PetscCall(Iterate(matrix, image, shift, sharp));
  }
  PetscCall(VecDestroy(&image));
  PetscCall(MatDestroy(&matrix));
  PetscCheck(sharp->theta <= bound.w2() * (1 + 1e-9), tables.comm, PETSC_ERR_PLIB,
             "the highest frequency is above its bound: w^2 %g above %g 1/s^2", sharp->theta, bound.w2());
  if (sharp->converged) {
    sharp->w2 = std::min(bound.w2(), sharp->theta + sharp->residual);
    sharp->dt = std::max(bound.dt, RoundedStep(CriticalStep(sharp->w2, tables.beta)));
  }
  PetscCall(PetscLogEventEnd(events.bound, nullptr, nullptr, nullptr, nullptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
