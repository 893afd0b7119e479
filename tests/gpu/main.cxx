#include "../unit/main.cxx"  // the same: inside PETSc
