// Runs a scene with the energy audit, and keeps its balance.
#pragma once
#include "run_scene.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

namespace cdem {

inline const char *const kAuditOn = " -monitor_energy ascii:/dev/null -monitor_energy_interval 50";

/// A file name of this process alone.
inline std::string OwnFile(const std::string &name) {
  return (std::filesystem::temp_directory_path() / (name + "_" + std::to_string(getpid()))).string();
}

/// A table sin^2 of height 1 that lasts so long, after a delay [s]; the file's name.
inline std::string PulseFile(double duration, double delay = 0) {
  const std::string path = OwnFile("cdem_pulse");
  std::ofstream file(path);
  file.precision(17);
  const int n = 400;
  if (delay > 0) file << "0, 0\n";
  for (int i = 0; i <= n; ++i)
    file << delay + duration * i / n << ", " << std::pow(std::sin(3.14159265358979323846 * i / n), 2) << "\n";
  file << 1e3 << ", 0\n";
  return path;
}

struct AuditRun {
  Balance last;
  std::vector<std::vector<double>> rows;  ///< of the monitor
  std::vector<std::string> names;         ///< of its columns

  explicit AuditRun(const std::string &options, MPI_Comm comm = PETSC_COMM_WORLD) {
    int rank = 0, world = 0;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_rank(PETSC_COMM_WORLD, &world);
    std::string path = OwnFile("cdem_energy" + std::to_string(world));
    std::vector<char> name(path.begin(), path.end());
    name.resize(256, 0);
    MPI_Bcast(name.data(), 256, MPI_CHAR, 0, comm);
    path = name.data();
    {
      std::unique_ptr<Simulation> s =
          SetUpScene(options + " -monitor_energy ascii:" + path + " -monitor_energy_interval 50", comm);
      if (!s || s->Solve() || s->Finish()) {
        ADD_FAILURE() << "the scene did not run: " << options;
        return;
      }
      last = s->balance();
    }
    if (rank != 0) return;
    std::ifstream file(path);
    std::string line, word;
    std::getline(file, line);
    std::istringstream head(line.substr(1));
    while (head >> word) names.push_back(word);
    while (std::getline(file, line)) {
      std::istringstream in(line);
      rows.emplace_back();
      while (in >> word) rows.back().push_back(std::stod(word));
    }
    std::filesystem::remove(path);
  }
  /// The largest error of all rows; they must be there, and say what the columns promise.
  double WorstError() const {
    double most = 0;
    for (const std::vector<double> &row : rows) {
      EXPECT_EQ(row.size(), names.size());
      if (!(row.back() <= most)) most = row.back();
    }
    return rows.empty() || names.back() != "error" ? std::numeric_limits<double>::infinity() : most;
  }
};

}  // namespace cdem
