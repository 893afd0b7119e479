#include "forces/host_element_run.hpp"

namespace cdem {

void WedgeElements(const ElementPass &pass, const ElementTable &t, ElementHistories *h) {
  RunElements<WedgeForms>(pass, t, h);
}

}  // namespace cdem
