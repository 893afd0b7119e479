#include "forces/host_element_run.hpp"

namespace cdem {

void HexElements(const ElementPass &pass, const ElementTable &t, ElementHistories *h) {
  RunElements<HexForms>(pass, t, h);
}

}  // namespace cdem
