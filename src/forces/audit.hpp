// The energy audit's own memory: what every element, spring and node has dissipated or been given so far. It exists only
// while the audit is on; backends add to it as they step.
#pragma once
#include "forces/tables.hpp"

#include <vector>

namespace cdem {

/// Energies that are added up for every element, for every spring, for every node, and for every row of NodeRecords [J].
enum ElementWork { kPlastic, kElementFracture, kElementBeta, kElementWorks };
enum SpringWork { kFriction, kSpringFracture, kContact, kSpringBeta, kSpringWorks };
enum NodeWork { kAlpha, kLocal, kNodeWorks };
enum RowWork { kQuietWork, kLoadWork, kWaveWork, kMotionWork, kRowWorks };

struct AuditArrays {
  std::vector<std::vector<double>> element;  ///< per table [kElementWorks][n_pad]; empty: it cannot dissipate
  std::vector<std::vector<double>> spring;   ///< per table [kSpringWorks][n_pad]; empty: it cannot dissipate
  std::vector<std::vector<double>> viscous;  ///< per table [3][n_pad] N, damping force of the step before; with beta
  std::vector<double> node;                  ///< [kNodeWorks][n_owned]
  std::vector<double> row;                   ///< [kRowWorks][records.n]
  std::vector<double> speed;                 ///< [n_local][3] m/s, velocity of the step before; with beta
  std::vector<double> dilatation;            ///< of the step before, as Averages has it; where elements average
  bool Empty() const { return node.empty(); }
};

/// Whether what a step dissipates in this table must be followed.
bool Audits(const Tables &tables, const ElementTable &t);
bool Audits(const Tables &tables, const SpringTable &t);

/// Nothing has happened yet.
AuditArrays StartAudit(const Tables &tables);

/// What a committing pass needs to follow the energies.
struct AuditPass {
  AuditArrays *arrays = nullptr;
  double dt = 0, next_dt = 0;  ///< s; of the step that ended, 0 at the start; of the coming one
  bool last = false;           ///< the sums are wanted as of now
};

/// Places of the terms of a balance in a list of sums; behind the first four those of elements, springs, nodes and rows.
enum AuditTerm { kKineticSum, kStrainSum, kSpringSum, kWeightSum, kElementSums0 };
inline constexpr int kSpringSums0 = kElementSums0 + kElementWorks, kNodeSums0 = kSpringSums0 + kSpringWorks;
inline constexpr int kRowSums0 = kNodeSums0 + kNodeWorks, kAuditTerms = kRowSums0 + kRowWorks;

/// The terms of a backend's balance, summed over all ranks in no order (J, and J of this stage alone).
struct AuditSums {
  double kinetic = 0, strain = 0, spring = 0;  ///< at u(n); kinetic is v(n-1/2).M v(n+1/2)/2
  double plastic = 0, friction = 0, fracture = 0, contact = 0;
  double alpha = 0, beta = 0, local = 0, quiet = 0;
  double loads = 0, wave = 0, motion = 0;
  double weight = 0;  ///< gravity times u(n): a function of state

  /// [in] sums: [kAuditTerms].
  static AuditSums Of(const std::vector<double> &sums);
};

}  // namespace cdem
