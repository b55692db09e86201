#include <map>
#include <memory>

#include "experiments/commands.h"
#include "experiments/menu.h"
#include "experiments/spec_keys.h"

namespace halfslope {
namespace {

// What each key of an experiment means, for --help of `run`.
std::string key_help(const std::string& key) {
  static const std::map<std::string, std::string> kHelp = {
      {"name", "the experiment's name; the default run folder is out/NAME"},
      {"scene", "see `halfslope list scenes`; or paths of Mitsuba 3 .xml files"},
      {"estimators",
       "[path-]HEURISTIC[:PARAMETER][@TECHNIQUE[*COUNT]+...], or a technique; default: light, bsdf, average, balance, "
       "power, or what the scene has instead"},
      {"samplers", "see `halfslope list samplers`"},
      {"samples", "sample counts N: 4:1024 for the powers of two from 4 to 1024, or a list"},
      {"replicates", "independent repetitions that errors are measured over (default 64)"},
      {"seed", "of every random number (default 1)"},
      {"resolution", "WIDTH,HEIGHT; default: the scene's own"},
      {"pixels", "all, or how many to measure (default all)"},
      {"images", "sample counts to write EXRs for, or none (default none)"},
      {"precision", "f32, f64 or f32,f64 (default f32)"},
      {"measures", "of the samplers' points, see `halfslope list measures`, or none (default none)"},
      {"interval", "of the RMSE: bootstrap-t, chi2, delta, bca or reciprocal-t (default bootstrap-t)"},
      {"target", "'rmse 5%': replicates are added until every rmse is known to ±5 %, at most --replicates (4096)"},
      {"budget", "60s, 2min or 1h: replicates are added where they narrow most, until the time is spent"},
      {"timing", "how often to time every cell by itself, such as 15, or none (default none)"},
      {"max_depth", "of paths: 1 sees emitters, 2 light that is scattered once (default: the scene's, or 8)"},
      {"russian_roulette", "the depth from which it ends paths, or none (default: the scene's, or none)"},
      {"checks",
       "theorems to hold the results against, balance-bound,one-sample-balance,average-bound,exact-variance, or none "
       "(default none)"},
  };
  const auto found = kHelp.find(key);
  return found == kHelp.end() ? "" : found->second;
}

}  // namespace

Command add_run(CLI::App& app) {
  const auto kept = std::make_shared<RunArguments>();
  RunArguments& run = *kept;
  CLI::App* command = app.add_subcommand("run", "run an experiment: every estimator x sampler over many replicates");
  command->add_option("experiment", run.file, "an experiment file (.toml); flags override it");
  for (const auto& key : spec_key_names()) {
    command
        ->add_option_function<std::string>(
            "--" + key, [kept, key](const std::string& value) { kept->keys[key] = value; }, key_help(key))
        ->type_name("VALUE");
  }
  command->add_option("--out", run.out, "run folder (default: out/NAME)")->type_name("DIR");
  add_threads(*command, run.threads, "threads; the results do not depend on it (default: all cores)");
  command->add_flag("--quiet", run.quiet, "no progress, no summary");
  command->add_flag("--dry-run", run.dry_run, "print the plan and what is skipped and why; measure nothing");
  command->add_flag("--overwrite", run.overwrite, "remove the results that the run folder holds and start afresh");
  command->add_flag("--json", run.json, "print the rows of convergence.csv as JSON instead of the summary");
  return {command, [kept](const Catalogue& catalogue) { return run_command(*kept, catalogue); }};
}

Command add_list(CLI::App& app) {
  const auto kept = std::make_shared<ListArguments>();
  ListArguments& list = *kept;
  CLI::App* command =
      app.add_subcommand("list", "list samplers, estimators, scenes, measures, metrics, figures and statuses");
  command->add_option("what", list.what, "samplers, estimators, scenes, measures, metrics, figures or statuses");
  command->add_flag("--json", list.json, "as JSON");
  command->add_flag("--names", list.names_only, "names alone, a line each");
  return {command, [kept](const Catalogue& catalogue) { return list_command(*kept, catalogue); }};
}

}  // namespace halfslope
