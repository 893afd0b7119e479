// TS type central with a stepper that only notes what it is asked to do.
#include "../support/run_scene.hpp"

#include <cmath>

namespace cdem {
namespace {

struct Noting final : Stepper {
  std::vector<StepPlan> plans;
  PetscInt look = PETSC_INT_MAX;  ///< somebody looks every so many steps
  PetscErrorCode Advance(const StepPlan &plan) override {
    plans.push_back(plan);
    return PETSC_SUCCESS;
  }
  PetscInt StepsToNext(PetscInt step, PetscReal, PetscReal) override {
    return look == PETSC_INT_MAX ? look : look - step % look;
  }
};

class CentralTS : public testing::Test {
 protected:
  void Run(const char *options, PetscInt batch = 0, const CentralState *start = nullptr) {
    ASSERT_PETSC(RegisterOnce());
    ASSERT_PETSC(PetscOptionsClear(nullptr));
    ASSERT_PETSC(PetscOptionsInsertString(nullptr, options));
    ASSERT_PETSC(VecCreateSeq(PETSC_COMM_SELF, 3, &u_));
    ASSERT_PETSC(VecDuplicate(u_, &v_));
    ASSERT_PETSC(CreateTSCentral(PETSC_COMM_SELF, &stepper_, batch, u_, v_, &ts_));
    ASSERT_PETSC(TSMonitorSet(ts_, Monitor, this, nullptr));
    ASSERT_PETSC(TSSetFromOptions(ts_));
    if (start) {
      ASSERT_PETSC(TSCentralSetState(ts_, *start));
    }
    ASSERT_PETSC(TSSolve(ts_, nullptr));
    ASSERT_PETSC(TSGetTime(ts_, &time_));
    ASSERT_PETSC(TSGetStepNumber(ts_, &steps_));
  }
  void TearDown() override {
    EXPECT_EQ(static_cast<int>(TSDestroy(&ts_)), 0);
    EXPECT_EQ(static_cast<int>(VecDestroy(&u_)), 0);
    EXPECT_EQ(static_cast<int>(VecDestroy(&v_)), 0);
  }
  static PetscErrorCode Monitor(TS, PetscInt step, PetscReal, Vec, void *self) {
    static_cast<CentralTS *>(self)->seen_.push_back(step);
    return PETSC_SUCCESS;
  }
  /// The plans follow on each other without a gap, and count and time are theirs.
  void ExpectChain(PetscInt steps, double time) {
    PetscInt at = 0;
    double end = 0, dt_old = 0;
    for (const StepPlan &plan : stepper_.plans) {
      EXPECT_EQ(plan.first, at);
      EXPECT_GE(plan.n, 1);
      EXPECT_NEAR(plan.Time(0), end, 1e-12 * time);
      EXPECT_EQ(plan.dt_old, dt_old);
      at += plan.n;
      end = plan.Time(plan.n);
      dt_old = plan.dt;
    }
    EXPECT_EQ(at, steps);
    EXPECT_EQ(steps_, steps) << "ts->steps";
    EXPECT_NEAR(end, time, 1e-12 * time);
  }
  Noting stepper_;
  TS ts_ = nullptr;
  Vec u_ = nullptr, v_ = nullptr;
  double time_ = 0;
  PetscInt steps_ = 0;
  std::vector<PetscInt> seen_;
};

TEST_F(CentralTS, HasItsType) {
  Run("-ts_dt 1 -ts_max_steps 1");
  TSType type;
  ASSERT_PETSC(TSGetType(ts_, &type));
  EXPECT_STREQ(type, "central");
  Vec u, v;
  ASSERT_PETSC(TS2GetSolution(ts_, &u, &v));
  EXPECT_EQ(u, u_);
  EXPECT_EQ(v, v_);
}

TEST_F(CentralTS, LandsOnTheEndTime) {
  const double dt = 0.7 / 2345;
  char options[100];
  std::snprintf(options, sizeof options, "-ts_max_time 0.7 -ts_dt %.17g -ts_max_steps 1000000", dt);
  Run(options);
  EXPECT_EQ(time_, 0.7);
  ExpectChain(2345, 0.7);
  EXPECT_EQ(stepper_.plans.size(), 3u);
  for (const StepPlan &plan : stepper_.plans) EXPECT_EQ(plan.dt, dt);
}

TEST_F(CentralTS, CutsTheLastStep) {
  Run("-ts_max_time 0.1 -ts_dt 0.03 -ts_max_steps 1000000");
  EXPECT_EQ(time_, 0.1);
  ExpectChain(4, 0.1);
  ASSERT_EQ(stepper_.plans.size(), 2u);
  EXPECT_EQ(stepper_.plans[0].n, 3);
  EXPECT_EQ(stepper_.plans[1].n, 1);
  EXPECT_NEAR(stepper_.plans[1].dt, 0.01, 1e-15);
  double last;
  ASSERT_PETSC(TSCentralGetLastStep(ts_, &last));
  EXPECT_EQ(last, stepper_.plans[1].dt);
}

TEST_F(CentralTS, OneStepLongerThanTheRunIsCut) {
  Run("-ts_max_time 0.1 -ts_dt 5 -ts_max_steps 1000000");
  EXPECT_EQ(time_, 0.1);
  ExpectChain(1, 0.1);
}

TEST_F(CentralTS, StopsAtTheLastStep) {
  Run("-ts_max_time 1e9 -ts_dt 0.25 -ts_max_steps 2500");
  EXPECT_EQ(time_, 625);
  ExpectChain(2500, 625);
  EXPECT_EQ(seen_, (std::vector<PetscInt>{0, 1000, 2000, 2500}));
}

TEST_F(CentralTS, BatchesEndWhereSomebodyLooks) {
  stepper_.look = 30;
  Run("-ts_max_time 1e9 -ts_dt 0.25 -ts_max_steps 100", 20);
  ExpectChain(100, 25);
  EXPECT_EQ(seen_, (std::vector<PetscInt>{0, 20, 30, 50, 60, 80, 90, 100}));
}

TEST_F(CentralTS, TimeDoesNotDriftOverManySteps) {
  Run("-ts_max_time 1e9 -ts_dt 0.1 -ts_max_steps 1000000");
  EXPECT_EQ(time_, 1000000 * 0.1);
}

TEST_F(CentralTS, GoesOnAsIfItHadNotStopped) {
  const double dt = 0.1;
  CentralState start;  // after a run to 100 dt that has put its time onto its end
  start.step = 100;
  start.time = std::nextafter(100 * dt, 11.0);
  start.dt = start.dt_old = dt;
  Run("-ts_max_time 1e9 -ts_dt 0.1 -ts_max_steps 1200", 0, &start);
  ASSERT_EQ(stepper_.plans.size(), 2u);
  const StepPlan &first = stepper_.plans[0];
  EXPECT_TRUE(first.first == 100 && first.base == 0 && first.offset == 100 && first.dt_old == dt)
      << "no first kick again";
  EXPECT_EQ(first.Time(5), 105 * dt);
  EXPECT_EQ(time_, 1200 * dt);
  EXPECT_EQ(seen_, (std::vector<PetscInt>{100, 1100, 1200}));
}

TEST_F(CentralTS, GoesOnAfterACutStepAndWithAnotherStep) {
  CentralState start;  // three steps of 0.03 and one of 0.01
  start.step = 4;
  start.base_step = 3;
  start.time = 0.1;
  start.base_time = 0.09;
  start.dt = start.dt_old = 0.01;
  Run("-ts_max_time 0.22 -ts_dt 0.03 -ts_max_steps 1000000", 0, &start);
  EXPECT_EQ(time_, 0.22);
  ASSERT_EQ(stepper_.plans.size(), 1u);
  const StepPlan &plan = stepper_.plans[0];
  EXPECT_TRUE(plan.first == 4 && plan.offset == 0 && plan.dt == 0.03 && plan.dt_old == 0.01 && plan.n == 4);
  EXPECT_NEAR(plan.base, 0.1, 1e-15);
}

TEST_F(CentralTS, NothingIsLeftToDoAtTheEnd) {
  CentralState start;
  start.step = 3;
  start.time = 0.3;
  start.dt = start.dt_old = 0.1;  // 3 * 0.1 is above 0.3
  Run("-ts_max_time 0.3 -ts_dt 0.1 -ts_max_steps 1000000", 0, &start);
  EXPECT_EQ(time_, 0.3);
  EXPECT_EQ(seen_, (std::vector<PetscInt>{3}));
  EXPECT_TRUE(stepper_.plans.empty());
}

}  // namespace
}  // namespace cdem
