// The law lists: a new law is its header and one name here.
#pragma once
#include "physics/block_breakage.hpp"
#include "physics/block_drucker_prager.hpp"
#include "physics/block_elastic.hpp"
#include "physics/block_mohr_coulomb.hpp"
#include "physics/block_spring.hpp"
#include "physics/joint_brittle.hpp"
#include "physics/joint_elastic.hpp"
#include "physics/joint_softening.hpp"

namespace cdem {

using BlockLaws = LawList<Elastic, DruckerPrager, MohrCoulomb, Breakage, SpringBlock, ElasticOffset, BreakageOffset,
                          SpringBlockOffset>;
using JointLaws = LawList<JointElastic, JointBrittle, JointBrittleDilating, JointSoftening, JointSofteningDilating,
                          JointElasticOffset>;

}  // namespace cdem
