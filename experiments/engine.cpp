#include "experiments/engine.h"

#include <chrono>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/kernel_library.h"
#include "core/random.h"
#include "core/version.h"
#include "experiments/fold.h"
#include "experiments/images.h"
#include "experiments/journal.h"
#include "experiments/manifest.h"
#include "experiments/message.h"
#include "experiments/plan_references.h"
#include "experiments/progress.h"
#include "experiments/run_folder.h"
#include "experiments/runner.h"
#include "experiments/stages.h"
#include "experiments/tables.h"
#include "experiments/timing_tables.h"

namespace halfslope {
namespace {

std::string run_hash(const Spec& spec, const Plan& plan) {
  std::string text = spec_hash(spec);
  for (const PlannedScene& scene : plan.scenes) text += "\n" + scene.source->fingerprint();
  for (const std::string& fingerprint : plan.sampler_fingerprints) text += "\n" + fingerprint;
  return fmt::format("{:016x}", hash_text(text));
}

/// Times the cells and writes what that gives; or removes what an earlier run that asked for it left.
void time_and_write(const Spec& spec, const Catalogue& catalogue, const RunOptions& options, const RunFolder& folder,
                    RunOutcome& outcome) {
  if (spec.timing == 0) {
    std::error_code ignored;
    for (const char* name : kTimingFiles) std::filesystem::remove(folder.path(name), ignored);
    return;
  }
  try {
    outcome.timed = timing_results(outcome.results, time_cells(outcome.plan, catalogue.samplers, spec.timing,
                                                               spec.name + ", timing", options.quiet));
  } catch (const Error& error) {
    if (error.code() != ExitCode::kInterrupted) throw;
    fail(ExitCode::kInterrupted, "{}; everything else is done and written: run the same command again for timing.csv",
         error.what());
  }
  const std::array texts = {timing_csv(outcome.timed), timing_parts_csv(outcome.timed), equal_time_csv(outcome.timed),
                            equal_error_csv(outcome.timed), timing_json(outcome.timed, spec.name)};
  for (std::size_t k = 0; k < texts.size(); ++k) write_file_atomically(folder.path(kTimingFiles[k]), texts[k]);
}

// A table of an earlier run that asked for it.
void remove_file(const std::filesystem::path& path) {
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
}

}  // namespace

RunOutcome run_experiment(const Spec& spec, const Catalogue& catalogue, const RunOptions& options) {
  const auto started = std::chrono::system_clock::now();
  RunOutcome outcome;
  outcome.plan = make_plan(spec, catalogue);
  const Plan& plan = outcome.plan;
  // What the user asked for and will not get must not be found out from a missing row.
  if (!options.quiet) {
    for (const auto& line : plan.left_out) message("halfslope: {}\n", line);
  }
  const RunFolder folder(options.out);
  options.overwrite ? folder.remove_results() : folder.refuse_images();
  Journal journal(folder.path(), {run_hash(spec, plan), version(), isa_class(active_isa())}, options.overwrite);
  if (journal.dropped_bytes() > 0 && !options.quiet) {
    message("halfslope: {} bytes at the journal's end were damaged by an interruption; those units are done again\n",
            journal.dropped_bytes());
  }
  const std::vector<Reference> references =
      make_references(plan, catalogue.samplers, {options.threads, options.quiet, default_cache()});
  {
    Progress progress(spec.name, plan.evaluations(), options.quiet);
    Runner runner(plan, references, catalogue.samplers, journal, progress, options.threads);
    set_replicates(outcome.plan, measure(spec, plan, references, runner));
    if (progress.done() > 0) {
      progress.finish();
    } else if (!options.quiet) {
      message("{}: everything was measured already; the tables are written anew\n", spec.name);
    }
  }
  journal.sync();
  AtomicFile replicates_file(folder.path("replicates.csv"));
  ReplicatesTable replicates;
  const CellVisitor visitor = {
      [&](const Cell& cell, const FoldedCell& folded) {
        if (cell.image) write_cell_image(folder.path(), plan, cell, folded, references);
      },
      [&](const Cell& cell, const FoldedCell& folded) {
        replicates.add(cell_name(plan, cell), folded.data.per_replicate);
        replicates_file.write(replicates.take_text());
      },
  };
  outcome.results = collect_results(plan, references, journal, catalogue.samplers, options.threads, visitor);
  replicates_file.commit();
  if (spec.target) mark_missed(outcome.results, *spec.target);
  if (!options.quiet) message("{}", report_stopping(spec, plan, outcome.results));
  outcome.results.comparisons = compare_cells(outcome.results.cells, options.threads);
  for (const CellResult& cell : outcome.results.cells) outcome.invalid_cells += cell.statistics.invalid ? 1 : 0;
  const auto write = [&](const char* name, const std::string& text) {
    if (!text.empty()) write_file_atomically(folder.path(name), text);
  };
  write_reference_images(folder.path(), plan, references);
  write("rates.csv", rates_csv(outcome.results));
  write("local_rates.csv", local_rates_csv(outcome.results));
  write("tails.csv", tails_csv(outcome.results));
  write("regions.csv", regions_csv(outcome.results));
  write("comparisons.csv", comparisons_csv(outcome.results));
  write("convergence.csv", convergence_csv(outcome.results));
  write("manifest.json", manifest_json(spec, plan, outcome.results, references, started));
  if (!spec.checks.empty()) {
    outcome.theory = check_theory(spec.checks, plan, outcome.results, references);
    write("theory.csv", theory_csv(outcome.theory));
  } else {
    remove_file(folder.path("theory.csv"));
  }
  // Last, since it is not part of the journal: what an interruption costs is these alone.
  try {
    outcome.measured =
        measure_points(plan.measures, catalogue.samplers, options.threads, spec.name + ", discrepancy", options.quiet);
  } catch (const Error& error) {
    if (error.code() != ExitCode::kInterrupted) throw;
    fail(ExitCode::kInterrupted,
         "{}; everything else is done and written: run the same command again for discrepancy.csv", error.what());
  }
  if (plan.measures.rows() > 0) {
    write_discrepancy_csv(folder.path("discrepancy.csv"), plan.measures, outcome.measured);
  } else {
    remove_file(folder.path("discrepancy.csv"));
  }
  time_and_write(spec, catalogue, options, folder, outcome);
  return outcome;
}

void note_finished_work(Plan& plan, const Spec& spec, const Catalogue& catalogue, const std::filesystem::path& out) {
  for (std::string& line : describe_cached_references(plan, catalogue.samplers, default_cache()))
    plan.skips.push_back(std::move(line));
  if (!std::filesystem::exists(out / "journal")) return;
  try {
    const RunFolder folder(out);
    const Journal journal(folder.path(), {run_hash(spec, plan), version(), isa_class(active_isa())}, false);
    plan.skips.push_back(fmt::format("{} of {} units of work are in {}: not measured again",
                                     finished_units(plan, journal), plan.units.size(), (out / "journal").string()));
  } catch (const Error& error) {
    // Another experiment's journal leaves nothing to skip; a folder that is busy cannot be looked into.
    if (error.code() != ExitCode::kBadInput) plan.skips.push_back(error.what());
  }
}

std::string describe_plan(const Spec& spec, const Plan& plan, const Catalogue& catalogue) {
  const auto count = [](auto n, const char* one, const char* many) {
    return fmt::format("{} {}", n, n == 1 ? one : many);
  };
  std::string text =
      fmt::format("{}: {} from {} in {}{} of work, {}{:.3g} integrand evaluations\n", spec.name,
                  count(plan.cells.size(), "cell", "cells"), count(plan.passes.size(), "pass", "passes"),
                  spec.in_stages() ? "at most " : "", count(plan.units.size(), "unit", "units"),
                  spec.in_stages() ? fmt::format("{:.3g} to ", least_evaluations(plan)) : "", plan.evaluations());
  text += describe_stopping(spec, plan);
  for (const Pass& pass : plan.passes) {
    const PlannedScene& scene = plan.scenes[pass.scene];
    std::vector<std::string> names;
    for (const std::size_t e : pass.estimators) names.push_back(scene.estimators[e].name);
    const int dims = pass.allocation.layout(scene.source->techniques()).dims();
    text += fmt::format("  {}, {}, {}: {} at N = {}{}, {} x {}, {}\n", scene.name, to_string(pass.precision),
                        pass.sampler, fmt::join(names, " + "), pass.samples.front(),
                        pass.samples.size() > 1 ? fmt::format(" … {}", pass.samples.back()) : "",
                        count(scene.pixels.size(), "pixel", "pixels"),
                        (pass.stages.size() > 1 ? fmt::format("{} to ", pass.stages.front()) : "") +
                            count(pass.replicates, "replicate", "replicates"),
                        count(dims, "dimension", "dimensions"));
  }
  text += describe_measures(plan.measures);
  const auto references = describe_references(plan, catalogue.samplers);
  if (!references.empty()) text += "references:\n";
  for (const auto& line : references) text += "  " + line + "\n";
  text += describe_timing(plan, spec.timing);
  text += "skipped:\n";
  for (const auto& skip : plan.skips) text += "  " + skip + "\n";
  return text;
}

}  // namespace halfslope
