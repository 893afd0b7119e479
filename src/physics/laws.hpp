// The law lists: a new law is its header and one name here.
#pragma once
#include "physics/block_elastic.hpp"
#include "physics/joint_brittle.hpp"
#include "physics/joint_elastic.hpp"
#include "physics/joint_softening.hpp"

namespace cdem {

using BlockLaws = LawList<Elastic>;
using JointLaws = LawList<JointElastic, JointBrittle, JointBrittleDilating, JointSoftening, JointSofteningDilating>;

}  // namespace cdem
