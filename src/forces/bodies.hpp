// The contents of the loops: one element, one spring, one node. Nothing else computes forces.
#pragma once
#include "forces/element_body.hpp"
#include "forces/node_step.hpp"
#include "forces/spring_body.hpp"
#include "forces/tables.hpp"
