#include "joints/network.hpp"

#include "core/error.hpp"
#include "core/options.hpp"
#include "joints/clip.hpp"

#include <algorithm>
#include <cmath>

namespace cdem {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kMostDraws = 1e9;       // some minutes
constexpr std::size_t kMostDiscs = 1e7;  // some GB
constexpr std::uint64_t kMostAtOnce = 1 << 16;

/// Draws discs [first, last), and keeps those that reach the region.
PetscErrorCode DrawDiscs(const DiscSource &source, const Region &region, std::uint64_t first, std::uint64_t last,
                         std::vector<Disc> *discs) {
  PetscFunctionBeginUser;
  discs->clear();
  for (std::uint64_t n = first; n < last; ++n) {
    Disc disc;
    if (source.Draw(n, &disc)) discs->push_back(disc);
  }
  PetscCall(region.Clip(discs));
  discs->erase(std::remove_if(discs->begin(), discs->end(), [](const Disc &d) { return d.inside <= 0; }), discs->end());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// Discs 0, 1, 2, ... until their number, or their area inside the region, is that wanted. The area ends at the disc that
/// brings it nearest: to stop when it is reached would on average overshoot by half a disc.
PetscErrorCode DrawSet(MPI_Comm comm, const Region &region, PetscInt seed, JointSet *set) {
  PetscFunctionBeginUser;
  const DiscSource source(set->law, seed, set->name, region.lower, region.upper);
  const double wanted = set->p32 * region.volume, mean_area = 0.25 * kPi * set->law.diameter.MeanSquare();
  const double expected = std::round((set->p32 > 0 ? set->p32 / mean_area : set->count) * source.Volume());
  const char *what = set->p32 > 0 ? "p32" : "count", *name = set->name.c_str();
  CdemCheck(
      expected <= kMostDraws, comm,
      "joint set '%s': its %s asks for about %.3g discs in the box of the region grown by the largest radius, %g m; "
      "the most is %g. Lower %s, or the largest diameter",
      name, what, expected, 0.5 * set->law.diameter.Largest(), kMostDraws,
      Options::Spelled({"joint", set->name, what}).c_str());
  CdemCheck(set->p32 > 0 || expected >= 1, comm,
            "joint set '%s': its count gives no disc: %g per m^3 in %g m^3, the box of the region grown by the largest "
            "radius. Raise %s",
            name, set->count, source.Volume(), Options::Spelled({"joint", set->name, "count"}).c_str());
  const std::uint64_t end = static_cast<std::uint64_t>(set->p32 > 0 ? 4 * kMostDraws : expected);
  const std::uint64_t at_once =
      static_cast<std::uint64_t>(std::clamp(expected / 4, 16.0, static_cast<double>(kMostAtOnce)));
  std::vector<Disc> some;
  double area = 0;
  bool reached = false;
  for (std::uint64_t n = 0; n < end && !reached; n += at_once) {
    PetscCall(DrawDiscs(source, region, n, std::min(n + at_once, end), &some));
    for (const Disc &disc : some) {
      const bool over = set->p32 > 0 && area + disc.inside >= wanted;
      reached = over;
      if (over && !set->discs.empty() && area + disc.inside - wanted > wanted - area) break;
      area += disc.inside;
      set->discs.push_back(disc);
      if (over) break;
    }
    CdemCheck(set->discs.size() <= kMostDiscs, comm,
              "joint set '%s': more than %zu discs reach its region. Lower %s, or let the discs be larger", name,
              kMostDiscs, Options::Spelled({"joint", set->name, what}).c_str());
  }
  CdemCheck(reached || set->p32 == 0, comm, "joint set '%s': its p32 was not reached with %g discs; lower %s", name,
            4 * kMostDraws, Options::Spelled({"joint", set->name, what}).c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/// The discs of a file that reach the region.
PetscErrorCode ClipFile(MPI_Comm comm, const Region &region, JointSet *set, std::vector<std::string> *remarks) {
  PetscFunctionBeginUser;
  const std::size_t before = set->discs.size();
  PetscCall(region.Clip(&set->discs));
  set->discs.erase(
      std::remove_if(set->discs.begin(), set->discs.end(), [](const Disc &disc) { return disc.inside <= 0; }),
      set->discs.end());
  const std::size_t lost = before - set->discs.size();
  CdemCheck(lost < before, comm,
            "joint set '%s': no disc of %s lies in its region, which reaches from (%g, %g, %g) to (%g, %g, %g) m",
            set->name.c_str(), set->file.c_str(), region.lower[0], region.lower[1], region.lower[2], region.upper[0],
            region.upper[1], region.upper[2]);
  if (lost > 0)
    remarks->push_back("joint set '" + set->name + "': " + std::to_string(lost) + " of " + std::to_string(before) +
                       " discs of " + set->file + " lie outside its region and are left out");
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace

PetscErrorCode CreateJointSets(const Mesh &mesh, Options &options, std::vector<JointSet> *sets,
                               std::vector<FaceSet> *faces, std::vector<std::string> *remarks) {
  PetscFunctionBeginUser;
  PetscInt seed = 1;
  PetscCall(ReadJointSets(mesh, options, sets));
  if (sets->empty()) PetscFunctionReturn(PETSC_SUCCESS);
  if (std::any_of(sets->begin(), sets->end(), [](const JointSet &set) { return set.file.empty(); }))
    PetscCall(options.Int("seed", &seed));
  const FaceTaker taker(mesh);
  for (JointSet &set : *sets) {
    Region region;
    PetscCall(region.Create(mesh, set.region));
    std::copy_n(region.lower, 3, set.lower);
    std::copy_n(region.upper, 3, set.upper);
    set.volume = region.volume;
    if (set.file.empty())
      PetscCall(DrawSet(mesh.comm, region, seed, &set));
    else
      PetscCall(ClipFile(mesh.comm, region, &set, remarks));
    for (const Disc &disc : set.discs) set.disc_area += disc.inside;
    faces->push_back({set.name, {}});
    PetscCall(taker.Take(&set, &faces->back().faces));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
