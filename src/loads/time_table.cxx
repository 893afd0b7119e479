#include "loads/time_table.hpp"

#include "core/error.hpp"
#include "core/options.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace cdem {

double TimeTable::At(double t) const {
  constexpr double pi = 3.14159265358979323846;
  switch (type) {
    case kConstant:
      return amplitude;
    case kRamp:
      return amplitude * (delay > 0 ? std::clamp(t / delay, 0.0, 1.0) : 1.0);
    case kSine:
      return t < delay ? 0 : amplitude * std::sin(2 * pi * frequency * (t - delay));
    case kRicker: {
      const double a = pi * frequency * (t - delay);
      return amplitude * (1 - 2 * a * a) * std::exp(-a * a);
    }
    case kFile:
      break;
  }
  if (t <= time.front()) return amplitude * value.front();
  if (t >= time.back()) return amplitude * value.back();
  const std::size_t i = std::upper_bound(time.begin(), time.end(), t) - time.begin();
  const double share = (t - time[i - 1]) / (time[i] - time[i - 1]);
  return amplitude * (value[i - 1] + share * (value[i] - value[i - 1]));
}

/// Reads lines "time value" or "time,value"; # begins a comment.
static PetscErrorCode ReadTableFile(MPI_Comm comm, const std::string &spelled, const std::string &path,
                                    TimeTable *table) {
  PetscFunctionBeginUser;
  std::ifstream in(path);
  CdemCheck(in, comm, "%s: the file %s cannot be read", spelled.c_str(), path.c_str());
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    line = line.substr(0, line.find('#'));
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    double t, v;
    std::string more;
    if (!(words >> more)) continue;
    words.clear();
    words.str(line);
    CdemCheck((words >> t >> v) && !(words >> more) && std::isfinite(t) && std::isfinite(v), comm,
              "%s: line %d of %s is not 'time value'", spelled.c_str(), number, path.c_str());
    CdemCheck(table->time.empty() || t > table->time.back(), comm, "%s: line %d of %s: the times must ascend",
              spelled.c_str(), number, path.c_str());
    table->time.push_back(t);
    table->value.push_back(v);
  }
  CdemCheck(!table->time.empty(), comm, "%s: the file %s holds no line 'time value'", spelled.c_str(), path.c_str());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReadTables(Options &options, std::vector<std::string> *names, std::vector<TimeTable> *tables) {
  PetscFunctionBeginUser;
  std::vector<std::string> declared;
  PetscCall(options.Names("tables", &declared));
  options.Declare("table", declared);
  names->assign(1, "");
  tables->assign(1, TimeTable());
  for (const std::string &name : declared) {
    TimeTable table;
    std::string type;
    bool set;
    PetscCall(options.Word({"table", name, "type"}, &type, &set));
    CdemCheck(set, options.comm(), "table '%s' has no type: give %s (constant, ramp, sine, ricker, file)", name.c_str(),
              Options::Spelled({"table", name, "type"}).c_str());
    const char *words[] = {"constant", "ramp", "sine", "ricker", "file"};
    for (int i = 0; i < 5; ++i)
      if (type == words[i]) table.type = static_cast<TimeTable::Type>(i);
    PetscCall(options.Real({"table", name, "amplitude"}, &table.amplitude));
    if (table.type == TimeTable::kSine || table.type == TimeTable::kRicker) {
      PetscCall(options.Real({"table", name, "frequency"}, &table.frequency, &set));
      CdemCheck(set && table.frequency > 0, options.comm(), "table '%s' is a %s: give %s above 0, in Hz", name.c_str(),
                type.c_str(), Options::Spelled({"table", name, "frequency"}).c_str());
    }
    if (table.type == TimeTable::kRamp || table.type == TimeTable::kSine || table.type == TimeTable::kRicker) {
      PetscCall(options.Real({"table", name, "delay"}, &table.delay, &set));
      CdemCheck(table.type != TimeTable::kRamp || (set && table.delay > 0), options.comm(),
                "table '%s' is a ramp: give %s above 0, in s (it reaches 1 there)", name.c_str(),
                Options::Spelled({"table", name, "delay"}).c_str());
    }
    if (table.type == TimeTable::kFile) {
      const OptionKey key("table", name, "file");
      std::string path;
      PetscCall(options.Text(key, &path, &set));
      CdemCheck(set, options.comm(), "table '%s' is a file: give %s", name.c_str(), Options::Spelled(key).c_str());
      PetscCall(ReadTableFile(options.comm(), Options::Spelled(key), path, &table));
    }
    names->push_back(name);
    tables->push_back(std::move(table));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem
