// Scenes whose elements can be computed in single precision: every shape and form, damped and not, with springs.
#pragma once
#include "run_scene.hpp"

namespace cdem {

inline std::vector<std::string> SingleScenes() {
  std::vector<std::string> scenes;
  for (const char *damping : {"", " -damping_beta 2e-5"}) {
    for (const char *body : {"hex full", "hex bbar", "hex onepoint", "wedge full", "wedge bbar", "tet full"}) {
      const std::string text = body, shape = text.substr(0, text.find(' '));
      scenes.push_back(StruckScene(shape, "-block_element " + text.substr(shape.size() + 1) + damping));
    }
    scenes.push_back(StruckScene("hex", std::string("-interfaces j -interface_j_on all -interface_j_law brittle "
                                                    "-interface_j_tension 2e5 -interface_j_cohesion 4e5 "
                                                    "-interface_j_friction 30") +
                                            damping));
  }
  return scenes;
}

}  // namespace cdem
