#include "experiments/plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "analysis/stopping.h"
#include "core/error.h"
#include "experiments/images.h"
#include "experiments/joined.h"
#include "experiments/left_out_counts.h"
#include "experiments/plan_notes.h"
#include "experiments/plan_units.h"
#include "experiments/reference.h"
#include "experiments/stopping_keys.h"
#include "experiments/theory.h"
#include "samplers/file_points.h"
#include "scenes/catalogue.h"

namespace halfslope {
namespace {

[[noreturn]] void fail_at(const Spec& spec, const std::string& key, const std::string& message) {
  const auto place = spec.places.find(key);
  const auto code = spec.codes.find(key);
  fail(code == spec.codes.end() ? ExitCode::kBadInput : static_cast<ExitCode>(code->second), "{}{}",
       place == spec.places.end() ? "" : place->second + ": ", message);
}

// Runs `make`; an error of it is about the value of `key`.
template <class Make>
auto at(const Spec& spec, const std::string& key, Make make) {
  try {
    return make();
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
    fail_at(spec, key, error.what());
  }
}

// `count` of `total` pixels, one in each of equal runs of the image: a fixed choice that covers it.
std::vector<int> choose_pixels(int total, std::optional<std::int64_t> wanted) {
  std::vector<int> pixels;
  if (!wanted || *wanted >= total) {
    pixels.resize(static_cast<std::size_t>(total));
    std::iota(pixels.begin(), pixels.end(), 0);
    return pixels;
  }
  const StreamKey key = stream_key(0, "pixels", "choice");
  for (std::int64_t i = 0; i < *wanted; ++i) {
    const std::int64_t begin = i * total / *wanted, end = (i + 1) * total / *wanted;
    const std::uint64_t word = random_word(key, Draw::kHigh, 0, static_cast<std::uint32_t>(i), 0, 0);
    pixels.push_back(
        static_cast<int>(begin + static_cast<std::int64_t>((word * static_cast<std::uint64_t>(end - begin)) >> 32)));
  }
  return pixels;
}

// The counts of the spec that the allocation and the sampler can take.
std::vector<std::uint64_t> legal_counts(const Spec& spec, const Estimator& estimator, const Sampler& sampler,
                                        const Layout& layout, LeftOutCounts& left_out) {
  std::vector<std::uint64_t> legal, skipped;
  std::string why;
  for (const std::uint64_t n : spec.samples.counts) {
    const std::string problem = illegal_samples(estimator, sampler, layout, n);
    if (problem.empty()) {
      legal.push_back(n);
    } else if (!spec.samples.is_range) {
      fail_at(spec, "samples", problem);
    } else {
      skipped.push_back(n);
      why = problem;
    }
  }
  if (!skipped.empty()) left_out.add(sampler.info().name, estimator.name, skipped, legal.empty(), why);
  return legal;
}

std::unique_ptr<IntegralSource> make_source(const Spec& spec, const Catalogue& catalogue, const std::string& name,
                                            bool paths, Plan& plan) {
  const auto make = [&](const Catalogue::Resolution& resolution) {
    if (paths) return catalogue.make_paths(name, resolution, {spec.max_depth, spec.russian_roulette});
    return catalogue.make_scene(name, resolution);
  };
  // A resolution is for those of several scenes that have one; of a lone scene it is a mistake where it means nothing.
  if (!spec.resolution || spec.scenes.size() == 1) return make(spec.resolution);
  auto source = make(std::nullopt);
  if (source->takes_resolution()) return make(spec.resolution);
  plan.skips.push_back(fmt::format("{}: is no picture: resolution does not apply", name));
  return source;
}

// Those of the spec's estimators that are of paths, or those that are not.
std::vector<std::string> estimators_of(const Spec& spec, bool paths) {
  std::vector<std::string> names;
  std::ranges::copy_if(spec.estimators, std::back_inserter(names),
                       [&](const std::string& name) { return is_path_estimator(name) == paths; });
  return names;
}

PlannedScene plan_scene(const Spec& spec, const Catalogue& catalogue, const std::string& name, bool paths, Plan& plan) {
  PlannedScene scene;
  scene.name = name;
  scene.paths = paths;
  const auto make = [&] { return make_source(spec, catalogue, name, paths, plan); };
  // A file's fault stays the file's, whoever named it: its errors begin with its own line.
  scene.source = is_scene_file(name) ? make() : at(spec, "scene", make);
  scene.pixels = choose_pixels(scene.source->pixels(), spec.pixels);
  const auto techniques = scene.source->techniques();
  for (const auto& estimator : spec.estimators.empty() ? default_estimators(techniques) : estimators_of(spec, paths)) {
    try {
      scene.estimators.push_back(catalogue.estimators.parse(estimator, *scene.source));
    } catch (const Error& error) {
      if (error.code() != ExitCode::kBadInput) throw;
      // What another of several scenes may take is left out here; what none takes is an error, told below.
      scene.misfits.emplace_back(estimator, fmt::format("scene '{}': {}", name, error.what()));
    }
  }
  for (const auto& skip : scene.source->skips()) plan.skips.push_back(fmt::format("{}: {}", name, skip));
  if (has_closed_form(*scene.source, scene.pixels))
    plan.skips.push_back(fmt::format("{}: its integral{} known in closed form: no reference is rendered", name,
                                     scene.source->pixels() == 1 ? " is" : "s are"));
  if (has_infinite_variance(*scene.source)) {
    plan.skips.push_back(
        fmt::format("{}: its variance is infinite, so no mean squared error exists: no rmse, no rate", name));
    plan.left_out.push_back(plan.skips.back());
  }
  if (scene.pixels.size() < static_cast<std::size_t>(scene.source->pixels())) {
    plan.skips.push_back(
        fmt::format("{}: {} of {} pixels are measured, as asked", name, scene.pixels.size(), scene.source->pixels()));
    if (!spec.images.empty())
      plan.skips.push_back(fmt::format("{}: no images, since not all pixels are measured", name));
  }
  return scene;
}

// Each scene as what its estimators integrate: direct light and paths are two integrals, each with its own reference.
void plan_scenes(const Spec& spec, const Catalogue& catalogue, Plan& plan) {
  const std::vector<std::string> of_paths = estimators_of(spec, true);
  const bool direct = spec.estimators.empty() || of_paths.size() < spec.estimators.size();
  bool some_has_paths = false;
  for (const auto& name : spec.scenes) {
    if (direct) plan.scenes.push_back(plan_scene(spec, catalogue, name, false, plan));
    if (of_paths.empty()) continue;
    if (!catalogue.has_paths(name)) {
      plan.skips.push_back(fmt::format("{}: is an integrand without paths; left out: {}", name, joined(of_paths)));
      plan.left_out.push_back(plan.skips.back());
      continue;
    }
    some_has_paths = true;
    plan.scenes.push_back(plan_scene(spec, catalogue, name, true, plan));
    if (direct) plan.scenes.back().name += ":paths";
  }
  if (!of_paths.empty() && !some_has_paths) {
    fail_at(spec, "estimators", fmt::format("'{}' is of paths, and no scene is a rendered one", of_paths.front()));
  }
}

// What is wrong with an estimator that no scene takes: as told by the scene that offers most, whose message knows most.
std::string best_problem(const Plan& plan, const std::string& estimator) {
  const auto most = std::max_element(plan.scenes.begin(), plan.scenes.end(), [](const auto& a, const auto& b) {
    return a.source->techniques().size() < b.source->techniques().size();
  });
  for (const auto& [name, problem] : most->misfits) {
    if (name == estimator) return problem;
  }
  return "";
}

// An estimator that some scene takes is left out where it does not fit; one that fits nowhere is a mistake.
void place_estimators(const Spec& spec, Plan& plan) {
  for (PlannedScene& scene : plan.scenes) {
    std::vector<std::string> left_out;
    for (const auto& [name, problem] : scene.misfits) {
      const bool fits_elsewhere = std::any_of(plan.scenes.begin(), plan.scenes.end(), [&](const PlannedScene& other) {
        return std::any_of(other.estimators.begin(), other.estimators.end(),
                           [&](const Estimator& e) { return e.name == name; });
      });
      if (!fits_elsewhere) fail_at(spec, "estimators", best_problem(plan, name));
      left_out.push_back(name);
    }
    if (left_out.empty()) continue;
    std::vector<std::string> techniques;
    for (const Technique& technique : scene.source->techniques()) techniques.push_back(technique.name);
    plan.skips.push_back(
        fmt::format("{}: has {} to draw with; left out: {}", scene.name, joined(techniques), joined(left_out)));
    if (scene.estimators.empty()) plan.left_out.push_back(plan.skips.back());
  }
}

// The pass that an estimator's cells share, made if it is not there.
std::size_t pass_for(Plan& plan, const Pass& wanted) {
  for (std::size_t p = 0; p < plan.passes.size(); ++p) {
    const Pass& pass = plan.passes[p];
    if (pass.scene == wanted.scene && pass.precision == wanted.precision && pass.sampler == wanted.sampler &&
        pass.allocation == wanted.allocation && pass.samples == wanted.samples) {
      return p;
    }
  }
  plan.passes.push_back(wanted);
  return plan.passes.size() - 1;
}

// A set is good as a whole: its first half says nothing of what its second half will be weighted by. Empty where the
// estimator takes the points.
std::string needs_sequence(const Estimator& estimator, const SamplerInfo& sampler) {
  if (estimator.heuristic.kind != HeuristicKind::kOptimalProgressive || sampler.sequence) return "";
  return fmt::format("'{}' weights samples by those before them, so it needs a sequence; left out with {}, a set",
                     estimator.name, sampler.name);
}

void remove_repeats(std::vector<std::string>& lines) {
  std::vector<std::string> unique;
  for (auto& line : lines) {
    if (std::find(unique.begin(), unique.end(), line) == unique.end()) unique.push_back(std::move(line));
  }
  lines = std::move(unique);
}

}  // namespace

std::string illegal_samples(const Estimator& estimator, const Sampler& sampler, const Layout& layout,
                            std::uint64_t samples) {
  const auto round = static_cast<std::uint64_t>(estimator.allocation.round());
  if (samples % round != 0) {
    const std::uint64_t below = samples / round * round;
    return fmt::format("'{}' takes {} samples a round, so N = {} does not divide; the nearest legal: {}{}",
                       estimator.name, round, samples, below > 0 ? std::to_string(below) + " and " : "", below + round);
  }
  if (const std::string problem = needs_sequence(estimator, sampler.info()); !problem.empty()) return problem;
  const auto neighbours = sampler.illegal(samples / round, layout);
  if (!neighbours) return "";
  std::string nearest;
  for (const auto& m : {neighbours->below, neighbours->above}) {
    if (m) nearest += (nearest.empty() ? "" : " and ") + std::to_string(*m * round);
  }
  return fmt::format("sampler '{}' cannot make N = {} in {} dimensions for '{}'; the nearest legal: {}",
                     sampler.info().name, samples, layout.dims(), estimator.name, nearest);
}

bool has_infinite_variance(const IntegralSource& source) {
  const std::optional<double> variance = source.variance();
  return variance && std::isinf(*variance);
}

CellName cell_name(const Plan& plan, const Cell& cell) {
  const PlannedScene& scene = plan.scenes[cell.scene];
  return {scene.name, scene.estimators[cell.estimator].name, cell.sampler, to_string(cell.precision), cell.samples};
}

Plan make_plan(const Spec& spec, const Catalogue& catalogue) {
  Plan plan;
  plan.interval = spec.interval;
  plan_scenes(spec, catalogue, plan);
  place_estimators(spec, plan);
  const auto is_picture = [](const PlannedScene& scene) { return scene.source->takes_resolution(); };
  const auto gives_rays = [](const PlannedScene& s) { return !s.source->takes_resolution() && s.source->pixels() > 1; };
  // As of a lone scene: rays given one by one refuse a resolution, an analytic scene does not mind it.
  if (spec.resolution && std::any_of(plan.scenes.begin(), plan.scenes.end(), gives_rays) &&
      std::none_of(plan.scenes.begin(), plan.scenes.end(), is_picture)) {
    fail_at(spec, "resolution", "no scene is a picture, so `resolution` applies to none");
  }
  std::vector<std::unique_ptr<Sampler>> samplers;
  for (const auto& name : spec.samplers) {
    const auto make = [&] { return catalogue.samplers.make(name); };
    samplers.push_back(point_file_of(name).empty() ? at(spec, "samplers", make) : make());
  }
  if (!spec.images.empty()) at(spec, "images", [&] { return check_image_folders(spec), 0; });
  for (const auto& sampler : samplers) {
    if (!sampler->info().fingerprint.empty()) plan.sampler_fingerprints.push_back(sampler->info().fingerprint);
  }

  LeftOutCounts left_out;
  for (std::size_t s = 0; s < plan.scenes.size(); ++s) {
    const PlannedScene& scene = plan.scenes[s];
    const bool whole = scene.pixels.size() == static_cast<std::size_t>(scene.source->pixels());
    for (const Precision precision : spec.precision) {
      for (std::size_t e = 0; e < scene.estimators.size(); ++e) {
        for (const auto& sampler : samplers) {
          const SamplerInfo& info = sampler->info();
          const Allocation& allocation = scene.estimators[e].allocation;
          const Layout layout = allocation.layout(scene.source->techniques());
          if (layout.dims() > info.max_dims && scene.paths) {
            plan.left_out.push_back(fmt::format("{}: has {} dimensions, and paths on scene '{}' take {}: left out",
                                                info.name, info.max_dims, scene.name, layout.dims()));
            plan.skips.push_back(plan.left_out.back());
            continue;
          }
          if (layout.dims() > info.max_dims) {
            fail_at(spec, "samplers",
                    fmt::format("sampler '{}' has {} dimensions; '{}' on scene '{}' takes {}", info.name, info.max_dims,
                                scene.estimators[e].name, scene.name, layout.dims()));
          }
          if (const std::string problem = needs_sequence(scene.estimators[e], info); !problem.empty()) {
            plan.left_out.push_back(problem), plan.skips.push_back(problem);
            continue;
          }
          Pass pass;
          pass.scene = s;
          pass.precision = precision;
          pass.sampler = info.name;
          pass.sequence = info.sequence;
          pass.randomised = info.randomised;
          pass.allocation = allocation;
          pass.samples = legal_counts(spec, scene.estimators[e], *sampler, layout, left_out);
          pass.replicates = info.replicates_of(spec.in_stages() ? spec.most_replicates : spec.replicates);
          pass.stages = spec.in_stages() ? replicate_schedule(pass.replicates, stages_per_doubling(spec))
                                         : std::vector{pass.replicates};
          pass.key = stream_key(spec.seed, info.name, "run");
          for (const std::string& caveat : info.caveats) plan.skips.push_back(fmt::format("{}: {}", info.name, caveat));
          if (pass.samples.empty()) continue;
          const std::size_t index = pass_for(plan, pass);
          auto& sharing = plan.passes[index].estimators;
          sharing.push_back(e);
          for (std::size_t n = 0; n < pass.samples.size(); ++n) {
            const bool image =
                whole && std::find(spec.images.begin(), spec.images.end(), pass.samples[n]) != spec.images.end();
            plan.cells.push_back({s, e, info.name, precision, pass.samples[n], index, sharing.size() - 1, n, image});
          }
        }
      }
    }
  }
  for (auto& line : left_out.lines()) plan.skips.push_back(std::move(line));
  for (auto& line : left_out.summary()) plan.left_out.push_back(std::move(line));
  if (plan.cells.empty()) {
    fail_at(spec, "samples",
            "nothing to measure: no sample count of the range is legal for any estimator and sampler. " +
                plan.left_out.front());
  }
  for (std::size_t p = 0; p < plan.passes.size(); ++p) add_units(plan, p);
  note_unused_techniques(plan);
  note_sharing(plan);
  note_optimal(plan);
  if (!spec.checks.empty()) {
    for (auto& line : left_out_of_checks(plan)) plan.left_out.push_back(line), plan.skips.push_back(std::move(line));
  }
  const std::size_t before = plan.left_out.size();
  plan.measures = plan_measures(spec, catalogue.samplers, plan.left_out);
  plan.skips.insert(plan.skips.end(), plan.left_out.begin() + static_cast<std::ptrdiff_t>(before), plan.left_out.end());
  remove_repeats(plan.skips);
  remove_repeats(plan.left_out);
  return plan;
}

}  // namespace halfslope
