// What a run's numbers are a function of, as text.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/random.h"
#include "experiments/spec.h"
#include "experiments/stopping_keys.h"

namespace halfslope {

std::string canonical_json(const Spec& spec) {
  nlohmann::json json;  // an ordered map: keys come out sorted
  json["scene"] = spec.scenes;
  json["estimators"] = spec.estimators;
  json["samplers"] = spec.samplers;
  json["samples"] = spec.samples.counts;  // a range and the list of its counts give the same numbers
  json["replicates"] = spec.in_stages() ? spec.most_replicates : spec.replicates;
  if (spec.in_stages()) json["stages_per_doubling"] = stages_per_doubling(spec);
  json["seed"] = spec.seed;
  json["resolution"] = spec.resolution ? nlohmann::json(*spec.resolution) : nlohmann::json();
  json["pixels"] = spec.pixels ? nlohmann::json(*spec.pixels) : nlohmann::json("all");
  json["images"] = spec.images;
  if (spec.max_depth) json["max_depth"] = *spec.max_depth;
  if (spec.russian_roulette) json["russian_roulette"] = *spec.russian_roulette;
  json["precision"] = nlohmann::json::array();
  for (Precision precision : spec.precision) json["precision"].push_back(to_string(precision));
  // A path need not be UTF-8; replacing its odd bytes beats refusing it.
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string spec_hash(const Spec& spec) { return fmt::format("{:016x}", hash_text(canonical_json(spec))); }

}  // namespace halfslope
