#include "forces/host_element_run.hpp"

namespace cdem {

void TetElements(const ElementPass &pass, const ElementTable &t, ElementHistories *h) {
  RunElements<TetForms>(pass, t, h);
}

}  // namespace cdem
