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

#ifdef CDEM_ELASTIC_ONLY  // what the others cost an elastic scene is measured against a build without them
using BlockLaws = LawList<Elastic>;
using JointLaws = LawList<JointElastic>;
#else
using BlockLaws = LawList<Elastic, DruckerPrager, MohrCoulomb, Breakage, SpringBlock, ElasticOffset, BreakageOffset,
                          SpringBlockOffset>;
using JointLaws = LawList<JointElastic, JointBrittle, JointBrittleDilating, JointSoftening, JointSofteningDilating,
                          JointElasticOffset>;
#endif

}  // namespace cdem
