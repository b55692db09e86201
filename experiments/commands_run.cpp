// run and list.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/image_metrics.h"
#include "analysis/measures.h"
#include "core/error.h"
#include "estimators/estimator.h"
#include "experiments/commands.h"
#include "experiments/engine.h"
#include "experiments/figures.h"
#include "experiments/images.h"
#include "experiments/interrupt.h"
#include "experiments/joined.h"
#include "experiments/manifest.h"
#include "experiments/message.h"
#include "experiments/plan_references.h"
#include "experiments/stages.h"
#include "experiments/tables.h"
#include "experiments/timing_tables.h"

namespace halfslope {
namespace {

using Json = nlohmann::ordered_json;

struct Listed {
  std::string name, description, reference, extra;
  std::optional<double> integral{}, variance{};
};

std::string number(double x) { return std::isinf(x) ? "infinite" : fmt::format("{:.6g}", x); }

// ", integral 0.5, variance 0.25", as far as they are known.
std::string moments(const SceneInfo& scene) {
  std::string text;
  if (scene.integral) text += ", integral " + number(*scene.integral);
  if (scene.variance) text += ", variance " + number(*scene.variance);
  return text;
}

std::vector<Listed> listed(const std::string& what, const Catalogue& catalogue) {
  std::vector<Listed> rows;
  if (what == "samplers") {
    for (const SamplerInfo& s : catalogue.samplers.list()) {
      const bool known = s.max_dims > 0;  // not for a family of files, each of which has dimensions of its own
      rows.push_back(
          {s.name, s.description, s.reference,
           known ? fmt::format("{}, {}, at most {} dimensions", s.sequence ? "sequence" : "set",
                               s.randomised ? "randomised" : "deterministic", s.max_dims)
                 : fmt::format("{}, replicates and dimensions are the file's", s.sequence ? "sequence" : "set")});
    }
  } else if (what == "estimators") {
    for (const EstimatorInfo& e : catalogue.estimators.list()) rows.push_back({e.name, e.description, e.reference, ""});
  } else if (what == "scenes") {
    for (const SceneInfo& s : catalogue.scenes()) {
      rows.push_back({s.parameters.empty() ? s.name : s.name + ":" + s.parameters, s.description, s.reference,
                      s.rendered ? "rendered" : "analytic" + moments(s), s.integral, s.variance});
    }
  } else if (what == "measures") {
    for (const MeasureInfo& m : measure_catalogue()) {
      const bool any = m.max_dims == std::numeric_limits<std::size_t>::max();
      std::string name = m.name;  // parameters as "pcf[:bins=200,max=...]"
      for (const Parameter& p : m.parameters)
        name += fmt::format("{}{}={}", name == m.name ? "[:" : ",", p.name, p.fallback.value_or(0));
      rows.push_back({m.parameters.empty() ? name : name + "]", m.description, m.reference,
                      fmt::format("{}{}", m.curve ? "a curve, " : "",
                                  any                        ? "any number of dimensions"
                                  : m.min_dims == m.max_dims ? fmt::format("{} dimensions", m.max_dims)
                                                             : fmt::format("at most {} dimensions", m.max_dims))});
    }
  } else if (what == "metrics") {
    for (const ImageMetric& m : image_metrics()) {
      rows.push_back({std::string(m.name), fmt::format("version {}: {}", m.version, m.formula),
                      std::string(m.reference), "mean over pixels and channels, then over replicates"});
    }
  } else if (what == "figures") {
    for (const FigureInfo& f : figure_catalogue()) rows.push_back({f.name, f.description, f.reference, ""});
  } else {
    rows = {
        {"ok", "nothing to say against the row's numbers", "", ""},
        {"target-missed", "the most replicates did not bring the rmse's interval within the target", "", ""},
        {"few-replicates", "below 16 replicates: the intervals are not certified", "", ""},
        {"no-spread",
         "all replicates err alike: nothing that contributes was met, or only rounding is left; no interval, no rate",
         "", ""},
        {"infinite-variance",
         "the integrand's variance is infinite: no mean squared error exists, so no rmse, no variance, no rate", "",
         ""},
        {"heavy-tailed",
         "corrected kurtosis above max(5, R/40): rare large errors; the intervals are not certified (tails.csv)", "",
         ""},
        {"reference-limited", "the reference's own variance is more than 10 % of the measured error, or all of it", "",
         ""},
        {"floor",
         "the measured error is within reach of the precision's rounding: more samples cannot lower it, and nothing is "
         "compared with it; of a rate: the errors stop falling, and the row is fitted above that",
         "", ""},
        {"rounding-limited", "the measured error is within reach of the precision's rounding: no rate is fitted", "",
         ""},
        {"deterministic", "one replicate: no variance, no kurtosis, no intervals", "", ""},
        {"exact", "every error is 0; equal time or error: there, or at a neighbouring N", "", ""},
        {"invalid", "an estimate or a reference is not finite; manifest.json names the first", "", ""},
        {"holds", "theory.csv: the measured number agrees with the theorem within its interval", "", ""},
        {"violated", "theory.csv: the whole interval lies beyond the bound, or beside the prediction", "", ""},
        {"too-few-points", "fewer than two sample counts: no rate is fitted", "", ""},
        {"pre-asymptotic",
         "the errors follow no line over all N: the rate is a mean of several; the row `asymptotic` says where they do",
         "", ""},
        {"asymptotic",
         "of a rate: from samples_lo on the errors follow a line, fitted with weights; theory.csv: the prediction is a "
         "limit, and there are too few rounds to be held to it",
         "", ""},
        {"variance", "of a rate: fitted to the sample variance, which needs no reference", "", ""},
        {"many-replicates", "above 4096 replicates: they are not kept, so the rate has no interval", "", ""},
        {"equal",
         "both sides of a comparison have the same squared errors but for rounding, replicate by replicate: there is "
         "nothing to tell",
         "", ""},
        {"few-repetitions", "fewer than 6 timings: their range covers the median with less than 95 %", "", ""},
        {"below-range",
         "equal time or error: the line's smallest N with an rmse takes longer already, or errs less already", "", ""},
        {"above-range", "equal time or error: the line's largest N with an rmse takes less, or errs more still", "",
         ""},
        {"no-rmse", "equal time or error: no N of the line has an rmse; its cells say why", "", ""},
        {"uncertified", "equal time or error: read off between cells whose intervals are not certified", "", ""}};
  }
  return rows;
}

}  // namespace

int run_command(const RunArguments& arguments, const Catalogue& catalogue) {
  const InterruptGuard guard;
  Spec spec;
  if (!arguments.file.empty()) spec = load_spec(arguments.file);
  for (const auto& [key, value] : arguments.keys) apply_flag(spec, key, value);
  validate(spec);
  const std::string out = arguments.out.empty() ? "out/" + path_component(spec.name) : arguments.out;
  if (arguments.dry_run) {
    Plan plan = make_plan(spec, catalogue);
    note_finished_work(plan, spec, catalogue, out);
    if (arguments.json) {
      fmt::print("{}\n", Json{{"name", spec.name},
                              {"cells", plan.cells.size()},
                              {"passes", plan.passes.size()},
                              {"units", plan.units.size()},
                              {"evaluations", plan.evaluations()},
                              {"evaluations_least", least_evaluations(plan)},
                              {"discrepancies", plan.measures.rows()},
                              {"references", describe_references(plan, catalogue.samplers)},
                              {"timings", spec.timing > 0 ? plan.cells.size() : 0},
                              {"skipped", plan.skips}}
                             .dump(2, ' ', false, Json::error_handler_t::replace));
    } else {
      fmt::print("{}", describe_plan(spec, plan, catalogue));
    }
    return static_cast<int>(ExitCode::kDone);
  }
  const RunOutcome outcome =
      run_experiment(spec, catalogue, {out, arguments.threads, arguments.quiet, arguments.overwrite});
  if (arguments.json) {
    fmt::print("{}", cells_json(outcome.results));
  } else if (!arguments.quiet) {
    const std::string measured = measures_summary(outcome.plan.measures, outcome.measured);
    const std::string timed = timing_summary(outcome.timed);
    const std::string theory = spec.checks.empty() ? "" : theory_summary(outcome.theory, spec.checks) + "\n";
    fmt::print("{}\n{}{}{}{}{}Tables and images: {}\n", summary(outcome.results), measured,
               measured.empty() ? "" : "\n", timed, timed.empty() ? "" : "\n", theory, out);
  }
  if (outcome.invalid_cells > 0) {
    message("halfslope: {} of {} cells are invalid (values that are not finite); see {}/manifest.json\n",
            outcome.invalid_cells, outcome.plan.cells.size(), out);
    return static_cast<int>(ExitCode::kCheckFailed);
  }
  if (const std::size_t violated = outcome.theory.violated(); violated > 0) {
    message("halfslope: {} of {} theory checks are violated; see {}/theory.csv\n", violated, outcome.theory.rows.size(),
            out);
    return static_cast<int>(ExitCode::kCheckFailed);
  }
  return static_cast<int>(ExitCode::kDone);
}

int list_command(const ListArguments& arguments, const Catalogue& catalogue) {
  const std::vector<std::string> kinds = {"samplers", "estimators", "scenes",  "measures",
                                          "metrics",  "figures",    "statuses"};
  if (!arguments.what.empty() && std::find(kinds.begin(), kinds.end(), arguments.what) == kinds.end()) {
    fail(ExitCode::kUsage, "there is no list of '{}'{}; allowed: {}", arguments.what,
         did_you_mean(arguments.what, kinds), joined(kinds));
  }
  Json json;
  for (const auto& kind : kinds) {
    if (!arguments.what.empty() && arguments.what != kind) continue;
    const auto rows = listed(kind, catalogue);
    std::size_t width = 0;
    for (const Listed& row : rows) width = std::max(width, row.name.size());
    if (arguments.names_only) {
      for (const Listed& row : rows) fmt::print("{}\n", row.name.substr(0, row.name.find_first_of(":[")));
      continue;
    }
    if (!arguments.json) fmt::print("{}{}\n", kind, arguments.what.empty() ? ":" : "");
    for (const Listed& row : rows) {
      if (arguments.json) {
        json[kind].push_back(
            {{"name", row.name}, {"description", row.description}, {"kind", row.extra}, {"reference", row.reference}});
        if (row.integral) json[kind].back()["integral"] = *row.integral;
        if (row.variance)
          json[kind].back()["variance"] = std::isinf(*row.variance) ? Json("infinite") : Json(*row.variance);
        continue;
      }
      fmt::print("  {:<{}}  {}\n", row.name, width, row.description);
      if (!row.extra.empty()) fmt::print("  {:<{}}  {}\n", "", width, row.extra);
      if (!row.reference.empty()) fmt::print("  {:<{}}  {}\n", "", width, row.reference);
    }
  }
  if (arguments.json) fmt::print("{}\n", json.dump(2));
  return static_cast<int>(ExitCode::kDone);
}

}  // namespace halfslope
