// Names of the files that a run writes into its folder.
#pragma once
#include <string>

namespace cdem {

/// Whether only a run writes a file of this name; one of the user's (terrain.hdf, rock_mesh_fine.h5) is none of them.
bool IsResult(const std::string &name);

/// Whether it is a temporary file that a killed run has left.
bool IsLeftover(const std::string &name);

/// The number in "<head>_<number><end>", -1 if the name is not of that form.
long long NumberIn(const std::string &name, const std::string &end, std::string *head);

}  // namespace cdem
