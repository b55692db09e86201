#include "experiments/spec.h"

#include <algorithm>

#include "core/error.h"
#include "experiments/joined.h"

namespace halfslope {
namespace {

// A flag that shares in a conflict caused it: without the flag, the file stands alone.
ExitCode code_of(const Spec& spec, std::initializer_list<const char*> keys) {
  bool from_file = false;
  for (const char* key : keys) {
    const auto found = spec.codes.find(key);
    if (found == spec.codes.end()) continue;
    if (found->second == static_cast<int>(ExitCode::kUsage)) return ExitCode::kUsage;
    from_file = true;
  }
  return from_file ? ExitCode::kBadInput : ExitCode::kUsage;
}

std::string place_of(const Spec& spec, const std::string& key) {
  const auto found = spec.places.find(key);
  return found == spec.places.end() ? key : found->second;
}

void require(const Spec& spec, const std::string& key, bool present) {
  if (present) return;
  const auto file = spec.places.find("");
  if (file == spec.places.end())
    fail(ExitCode::kUsage, "--{0} is missing: give it, or an experiment file with the key '{0}'", key);
  fail(ExitCode::kBadInput, "{0}: key '{1}' is missing: add it, or give --{1}", file->second, key);
}

}  // namespace

std::string to_string(Precision precision) { return precision == Precision::kF32 ? "f32" : "f64"; }

void validate(const Spec& spec) {
  require(spec, "scene", !spec.scenes.empty());
  require(spec, "samplers", !spec.samplers.empty());
  require(spec, "samples", !spec.samples.counts.empty());
  if (spec.target && spec.budget) {
    fail(code_of(spec, {"target", "budget"}),
         "{}: a target and a budget ({}) exclude each other; leave one out, or set it to 'none'",
         place_of(spec, "target"), place_of(spec, "budget"));
  }
  const std::vector<std::uint64_t>& samples = spec.samples.counts;
  for (std::uint64_t count : spec.images)
    if (!std::binary_search(samples.begin(), samples.end(), count))
      fail(code_of(spec, {"images", "samples"}),
           "{}: image count {} is not among the samples of {} ({}); take one of these, or none with --images none",
           place_of(spec, "images"), count, place_of(spec, "samples"), joined(samples));
}

}  // namespace halfslope
