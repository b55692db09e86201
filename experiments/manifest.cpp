#include "experiments/manifest.h"

#include <sys/utsname.h>

#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/error.h"
#include "core/kernel_library.h"
#include "core/version.h"
#include "experiments/stopping_keys.h"

namespace halfslope {
namespace {

using Json = nlohmann::ordered_json;

std::string utc_text(std::chrono::system_clock::time_point moment) {
  const std::time_t now = std::chrono::system_clock::to_time_t(moment);
  std::tm utc = {};
  gmtime_r(&now, &utc);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                     utc.tm_hour, utc.tm_min, utc.tm_sec);
}

// A path need not be UTF-8; replacing its odd bytes beats refusing it after the run.
std::string text_of(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

Json optional(const std::optional<double>& x) { return x ? Json(*x) : Json(nullptr); }

// How many replicates each pass came to: with the experiment, what the tables of a budget are a function of.
Json passes_json(const Plan& plan) {
  Json passes = Json::array();
  for (const Pass& pass : plan.passes) {
    const PlannedScene& scene = plan.scenes[pass.scene];
    Json estimators = Json::array();
    for (const std::size_t e : pass.estimators) estimators.push_back(scene.estimators[e].name);
    passes.push_back({{"scene", scene.name},
                      {"precision", to_string(pass.precision)},
                      {"sampler", pass.sampler},
                      {"estimators", estimators},
                      {"samples", pass.samples},
                      {"replicates", pass.replicates},
                      {"evaluations", plan.evaluations(pass, pass.replicates)}});
  }
  return passes;
}

}  // namespace

std::string manifest_json(const Spec& spec, const Plan& plan, const Results& results,
                          const std::vector<Reference>& references, std::chrono::system_clock::time_point started) {
  utsname host = {};
  uname(&host);
  Json manifest;
  manifest["schema_version"] = 1;
  manifest["name"] = spec.name;
  manifest["spec"] = Json::parse(canonical_json(spec));
  if (!spec.measures.empty()) manifest["spec"]["measures"] = spec.measures;
  if (spec.target) manifest["spec"]["target"] = target_text(*spec.target);
  if (spec.budget) manifest["spec"]["budget"] = budget_text(*spec.budget);
  if (spec.timing > 0) manifest["spec"]["timing"] = spec.timing;
  if (!spec.checks.empty()) manifest["spec"]["checks"] = spec.checks;
  manifest["spec_hash"] = spec_hash(spec);
  manifest["version"] = version();
  manifest["compiler"] = compiler();
  manifest["isa"] = to_string(active_isa());
  manifest["isa_class"] = isa_class(active_isa());
  manifest["host"] = {{"system", host.sysname},
                      {"release", host.release},
                      {"machine", host.machine},
                      {"cores", std::thread::hardware_concurrency()}};
  const auto finished = std::chrono::system_clock::now();
  manifest["started"] = utc_text(started);
  manifest["finished"] = utc_text(finished);
  manifest["seconds"] = std::chrono::duration<double>(finished - started).count();
  manifest["cells"] = plan.cells.size();
  manifest["evaluations"] = plan.evaluations();
  manifest["skipped"] = plan.skips;
  if (spec.in_stages()) manifest["passes"] = passes_json(plan);
  if (!plan.sampler_fingerprints.empty()) manifest["sampler_fingerprints"] = plan.sampler_fingerprints;
  for (std::size_t s = 0; s < plan.scenes.size(); ++s) {
    manifest["references"].push_back({{"scene", plan.scenes[s].name},
                                      {"origin", references[s].origin},
                                      {"samples", references[s].samples},
                                      {"replicates", references[s].replicates},
                                      {"mean", references[s].mean},
                                      {"mean_se", references[s].mean_se},
                                      {"mean_variance", references[s].mean_variance}});
    if (const auto pixel = references[s].first_nonfinite(plan.scenes[s].source->channels()))
      manifest["references"].back()["first_nonfinite_pixel"] = plan.scenes[s].pixels[*pixel];
  }
  manifest["invalid"] = Json::array();
  for (const CellResult& result : results.cells) {
    if (!result.statistics.invalid) continue;
    Json entry = {{"cell", to_string(result.name)}, {"nonfinite", result.statistics.nonfinite}};
    if (result.statistics.nonfinite > 0) {
      entry["first_replicate"] = result.first_bad_replicate;
      entry["first_pixel"] = result.first_bad_pixel;
      entry["seed"] = spec.seed;
    }
    manifest["invalid"].push_back(std::move(entry));
  }
  return text_of(manifest);
}

std::string cells_json(const Results& results) {
  Json cells = Json::array();
  for (const CellResult& cell : results.cells) {
    const CellStatistics& s = cell.statistics;
    const auto if_known = [&](double x) { return cell.facts.reference_known ? Json(x) : Json(); };
    cells.push_back({{"scene", cell.name.scene},
                     {"estimator", cell.name.estimator},
                     {"sampler", cell.name.sampler},
                     {"precision", cell.name.precision},
                     {"samples", cell.name.samples},
                     {"replicates", cell.replicates},
                     {"pixels", cell.pixels},
                     {"mean", optional(s.mean)},
                     {"reference", s.reference},
                     {"reference_se", if_known(s.reference_se)},
                     {"reference_mse", if_known(s.reference_mse)},
                     {"bias", optional(s.bias)},
                     {"bias_se", optional(s.bias_se)},
                     {"variance", optional(s.variance)},
                     {"rmse", optional(s.rmse)},
                     {"rmse_lo", optional(s.rmse_lo)},
                     {"rmse_hi", optional(s.rmse_hi)},
                     {"mae", optional(s.mae)},
                     {"relmse", optional(s.relmse)},
                     {"kurtosis", optional(s.kurtosis)},
                     {"median_abs_error", optional(s.median_abs_error)},
                     {"nonfinite", s.nonfinite},
                     {"status", s.status}});
  }
  return text_of(cells);
}

}  // namespace halfslope
