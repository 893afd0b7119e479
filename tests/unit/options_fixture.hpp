// A database of options of its own for each test, and what a refusal must say.
#pragma once
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace cdem {

class OptionsTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(PetscOptionsCreate(&database_), PETSC_SUCCESS);
    ASSERT_EQ(PetscOptionsPush(database_), PETSC_SUCCESS);
  }
  void TearDown() override {
    EXPECT_EQ(PetscOptionsPop(), PETSC_SUCCESS);
    EXPECT_EQ(PetscOptionsDestroy(&database_), PETSC_SUCCESS);
  }
  void Give(const char *line) { ASSERT_EQ(PetscOptionsInsertString(nullptr, line), PETSC_SUCCESS); }
  void GiveYaml(const char *text) { ASSERT_EQ(PetscOptionsInsertStringYAML(nullptr, text), PETSC_SUCCESS); }

  // The message of a call that must fail; "" if it does not.
  std::string Refusal(const std::function<PetscErrorCode()> &call) {
    testing::internal::CaptureStderr();
    const PetscErrorCode code = call();
    std::string text = testing::internal::GetCapturedStderr();
    EXPECT_EQ(code, PETSC_ERR_USER_INPUT) << text;
    const std::string start = "cdem: error: ";
    int rank = 0;
    MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
    if (rank > 0) return "";
    EXPECT_EQ(text.find(start), 0u) << text;
    return text.substr(start.size());
  }
  void ExpectRefused(const std::function<PetscErrorCode()> &call, const std::vector<const char *> &words) {
    const std::string text = Refusal(call);
    if (text.empty()) return;
    for (const char *word : words) EXPECT_NE(text.find(word), std::string::npos) << "no '" << word << "' in: " << text;
  }
  void ExpectLeftRefused(const std::vector<const char *> &words) {
    ExpectRefused([&] { return options_.CheckLeft(); }, words);
  }
  bool IsSet(const OptionKey &key) {
    bool set = false;
    EXPECT_EQ(options_.Has(key, &set), PETSC_SUCCESS);
    return set;
  }

  Options options_{PETSC_COMM_WORLD};
  PetscOptions database_ = nullptr;
};

}  // namespace cdem
