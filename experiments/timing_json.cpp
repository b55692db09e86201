// timing.json: what Google Benchmark's tools read.
#include <unistd.h>

#include <array>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/kernel_library.h"
#include "core/version.h"
#include "experiments/timing_tables.h"

namespace halfslope {
namespace {

using Json = nlohmann::ordered_json;

/// RFC 3339, as Google Benchmark writes it: "2026-02-03T04:05:06+01:00".
std::string local_time() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm local = {};
  localtime_r(&now, &local);
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S%z", &local);
  std::string date = text.data();
  return date.insert(date.size() - 2, 1, ':');  // strftime writes +0100
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

// A path need not be UTF-8.
std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// Slashes separate the name's parts, so those of a scene's path are kept out of it.
std::string benchmark_name(const CellName& name) {
  std::string scene = name.scene;
  std::ranges::replace(scene, '/', '|');
  return fmt::format("{}/{}/{}/{}/{}", scene, name.estimator, name.sampler, name.precision, name.samples);
}

Json entry(const TimingResult& row, std::size_t family, std::size_t repetition) {
  const TimedRun& run = row.times.runs[repetition];
  const auto samples = static_cast<double>(row.name.samples);
  const std::string name = benchmark_name(row.name);
  Json json = {{"name", name},
               {"family_index", family},
               {"per_family_instance_index", 0},
               {"run_name", name},
               {"run_type", "iteration"},
               {"repetitions", row.times.runs.size()},
               {"repetition_index", repetition},
               {"threads", 1},
               {"iterations", row.times.estimates},
               {"real_time", run.wall_ns * samples},
               {"cpu_time", run.all_ns * samples},
               {"time_unit", "ns"},
               {"ns_per_sample", run.all_ns}};
  if (row.rmse) {
    json["rmse"] = row.rmse->value;
    json["efficiency"] = 1 / (row.rmse->value * row.rmse->value * samples * run.all_ns * 1e-9);
  }
  return json;
}

}  // namespace

std::string timing_json(const std::vector<TimingResult>& rows, const std::string& experiment) {
  const Json context = {{"date", local_time()},           {"host_name", host_name()},
                        {"executable", "halfslope run"},  {"num_cpus", std::thread::hardware_concurrency()},
                        {"caches", Json::array()},        {"experiment", experiment},
                        {"halfslope_version", version()}, {"isa", to_string(active_isa())}};
  // Many runs make a long file, so an entry is a line.
  std::string entries;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t repetition = 0; repetition < rows[r].times.runs.size(); ++repetition)
      entries += (entries.empty() ? "\n" : ",\n") + text_of(entry(rows[r], r, repetition));
  }
  return fmt::format("{{\n\"context\": {},\n\"benchmarks\": [{}\n]\n}}\n", text_of(context), entries);
}

}  // namespace halfslope
