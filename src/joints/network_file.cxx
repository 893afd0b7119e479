// Discs in files: the user's, and joints.csv.
#include "core/error.hpp"
#include "core/options.hpp"
#include "joints/network.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace cdem {

PetscErrorCode ReadDiscs(MPI_Comm comm, const std::string &spelled, const std::string &path, std::vector<Disc> *discs) {
  PetscFunctionBeginUser;
  std::ifstream in(path);
  std::string line;
  // a folder opens, too, but gives no line
  CdemCheck(in && in.peek() != std::ifstream::traits_type::eof(), comm, "%s: the file %s cannot be read or is empty",
            spelled.c_str(), path.c_str());
  for (int number = 1; std::getline(in, line); ++number) {
    line = line.substr(0, line.find('#'));
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    double value[6];
    int n = 0;
    std::string word;
    for (; words >> word; ++n)
      CdemCheck(n >= 6 || ParseReal(word, &value[n]), comm,
                "%s: line %d of %s: '%s' is not a finite number; a line is 'x y z dip dip_direction diameter'",
                spelled.c_str(), number, path.c_str(), word.c_str());
    if (n == 0) continue;
    CdemCheck(
        n == 6, comm,
        "%s: line %d of %s has %d number%s instead of 6; a line is 'x y z dip dip_direction diameter' (m, degrees)",
        spelled.c_str(), number, path.c_str(), n, n == 1 ? "" : "s");
    CdemCheck(value[3] >= 0 && value[3] <= 90, comm, "%s: line %d of %s: the dip is %g; it is from 0 to 90 degrees",
              spelled.c_str(), number, path.c_str(), value[3]);
    CdemCheck(value[4] >= 0 && value[4] <= 360, comm,
              "%s: line %d of %s: the dip direction is %g; it is from 0 to 360 degrees", spelled.c_str(), number,
              path.c_str(), value[4]);
    CdemCheck(value[5] > 0, comm, "%s: line %d of %s: the diameter is %g m; it must be above 0", spelled.c_str(),
              number, path.c_str(), value[5]);
    Disc disc;
    std::copy_n(value, 3, disc.centre);
    NormalOf(value[3], value[4], disc.normal);
    disc.radius = 0.5 * value[5];
    discs->push_back(disc);
  }
  CdemCheck(!discs->empty(), comm, "%s: the file %s holds no line 'x y z dip dip_direction diameter'", spelled.c_str(),
            path.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

std::string DiscTable(const std::vector<JointSet> &sets) {
  std::string text = "set,x,y,z,dip,dip_direction,diameter,area_inside\n";
  char row[256];
  for (const JointSet &set : sets)
    for (const Disc &disc : set.discs) {
      double dip, direction;
      AnglesOf(disc.normal, &dip, &direction);
      std::snprintf(row, sizeof row, ",%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", disc.centre[0], disc.centre[1],
                    disc.centre[2], dip, direction, 2 * disc.radius, disc.inside);
      text += set.name + row;
    }
  return text;
}

}  // namespace cdem
