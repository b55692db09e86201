// Experiments run in this process, in a temporary folder.
#pragma once

#include <cstdlib>
#include <map>
#include <string>

#include "experiments/engine.h"
#include "experiments/spec.h"
#include "tests/experiments/csv_table.h"
#include "tests/experiments/temporary_folder.h"

namespace halfslope {

/// A spec from keys as the flags spell them: {"samples", "4:64"}.
inline Spec spec_of(const std::map<std::string, std::string>& keys) {
  Spec spec;
  for (const auto& [key, value] : keys) apply_flag(spec, key, value);
  validate(spec);
  return spec;
}

/// A folder for runs and for the cache of references.
class RunScope {
 public:
  RunScope() { ::setenv("HALFSLOPE_CACHE", (folder_ / "cache").c_str(), 1); }
  ~RunScope() { ::unsetenv("HALFSLOPE_CACHE"); }

  RunOutcome run(const std::map<std::string, std::string>& keys, const char* out = "out",
                 const Catalogue& catalogue = Catalogue::built_in()) const {
    return run_experiment(spec_of(keys), catalogue, {.out = folder_ / out, .quiet = true});
  }
  CsvTable table(const char* file, const char* out = "out") const { return CsvTable::read(folder_ / out / file); }
  std::filesystem::path path(const char* name) const { return folder_ / name; }

 private:
  const TemporaryFolder folder_;
};

}  // namespace halfslope
