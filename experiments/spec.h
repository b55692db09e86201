// What a user asks for: an experiment, from a TOML file, from flags, or from both.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/interval_methods.h"

namespace halfslope {

enum class Precision : std::uint8_t { kF32, kF64 };
std::string to_string(Precision precision);

/// The sample counts asked for. Inside a range the counts that a sampler cannot take are skipped, and the plan says so;
/// in a list they are errors.
struct SampleCounts {
  std::vector<std::uint64_t> counts;  ///< ascending, no duplicates, each ≥ 1
  bool is_range = false;
};

/// A validated experiment. Names are checked against the catalogues by the plan, which knows them.
struct Spec {
  std::string name = "run";
  std::vector<std::string> scenes;      ///< catalogue names or paths of Mitsuba .xml files; key `scene`
  std::vector<std::string> estimators;  ///< default {"mean"} is decided by the plan where this is empty
  std::vector<std::string> samplers;
  SampleCounts samples;
  std::int64_t replicates = 64;
  std::uint64_t seed = 1;
  std::optional<std::array<int, 2>> resolution;  ///< the sensor's own where absent
  std::optional<std::int64_t> pixels;            ///< a fixed, stratified choice of so many; all where absent
  std::vector<std::uint64_t> images;             ///< sample counts to write EXRs for
  std::vector<Precision> precision = {Precision::kF32};
  std::vector<std::string> measures;  ///< of the points that the samplers gave; in the order of measure_catalogue()
  IntervalMethod interval = IntervalMethod::kBootstrapT;  ///< of the RMSE
  std::optional<double> target;  ///< replicates stop where every RMSE is known to ± this share of it
  std::optional<double> budget;  ///< seconds that the cells share; not together with a target
  /// Of a run that decides on the way how many replicates it takes; the key `replicates` sets both.
  std::int64_t most_replicates = 4096;
  bool in_stages() const { return target || budget; }
  int timing = 0;                       ///< repetitions of each cell's timing; 0: nothing is timed
  std::optional<int> max_depth;         ///< of paths; absent: the scene's own, or 8
  std::optional<int> russian_roulette;  ///< from this depth of paths on, 0: none; absent: as the scene says, or none
  std::vector<std::string> checks;      ///< theorems to hold the results against; in the order of theory_checks()

  /// Where each key was set, for messages: "file.toml:3:9" or "--samplers". The empty key is the file itself.
  std::map<std::string, std::string> places;
  /// Exit code of an error about a key: 2 where a flag set it, 3 where a file did.
  std::map<std::string, int> codes;
};

/// Reads an experiment; `file` is its name in messages. Errors are Error(kBadInput) and begin with file:line:column.
Spec parse_spec_toml(std::string_view text, const std::string& file);

/// The same from a path; Error(kBadInput) if the file is missing or unreadable.
Spec load_spec(const std::filesystem::path& path);

/// Sets a key as the flag --KEY VALUE does: the value replaces the file's, lists are separated by commas (a comma
/// before `identifier=` continues a name with parameters, one after a backslash is a name's own), a resolution is 96,64
/// or 96x64. Errors are Error(kUsage) and begin with "--key: ", or with the name that the flag has there instead.
void apply_flag(Spec& spec, std::string_view key, std::string_view value, std::string_view shown_as = {});

/// Checks what no single key can show: the keys without a default are there, and images ⊂ samples. Error(kUsage) where
/// flags are at fault, Error(kBadInput) where the file is.
void validate(const Spec& spec);

/// Everything that determines the estimates of a run, as canonical JSON (sorted keys, no spaces): no name, no places,
/// no output folder, no threads, no measures, which are taken of the points alone, no interval, which is made of the
/// estimates afterwards, and no timing. Of a target or a budget it has the stages alone: they say which estimates there
/// are to choose from, whatever is chosen.
std::string canonical_json(const Spec& spec);

/// 16 hexadecimal digits that stand for canonical_json(spec).
std::string spec_hash(const Spec& spec);

}  // namespace halfslope
