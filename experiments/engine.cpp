#include "experiments/engine.h"

#include <tbb/task_group.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/kernel_library.h"
#include "core/random.h"
#include "core/version.h"
#include "experiments/fold.h"
#include "experiments/images.h"
#include "experiments/interrupt.h"
#include "experiments/journal.h"
#include "experiments/manifest.h"
#include "experiments/message.h"
#include "experiments/parallel.h"
#include "experiments/plan_references.h"
#include "experiments/progress.h"
#include "experiments/run_folder.h"
#include "experiments/tables.h"
#include "experiments/unit.h"

namespace halfslope {
namespace {

std::string run_hash(const Spec& spec, const Plan& plan) {
  std::string text = spec_hash(spec);
  for (const PlannedScene& scene : plan.scenes) text += "\n" + scene.source->fingerprint();
  for (const std::string& fingerprint : plan.sampler_fingerprints) text += "\n" + fingerprint;
  return fmt::format("{:016x}", hash_text(text));
}

/// Takes units in order and journals them; every thread until none is left, one fails, or a signal comes.
class Runner {
 public:
  Runner(const Plan& plan, std::span<const Reference> references, const Catalogue& catalogue, Journal& journal,
         bool quiet, const std::string& label)
      : plan_(plan),
        references_(references),
        catalogue_(catalogue),
        journal_(journal),
        progress_(label, remaining(), quiet) {}

  void run(int threads) {
    with_threads(threads, [&](int count) {
      tbb::task_group group;
      for (int t = 0; t < count; ++t) group.run([&] { work(); });
      group.wait();
    });
    if (failure_) std::rethrow_exception(failure_);
    if (interrupted()) {
      fail(ExitCode::kInterrupted, "interrupted; {} of {} units are done: run the same command again to go on",
           journal_.size(), plan_.units.size());
    }
    progress_.finish();
  }

 private:
  double remaining() const {
    double sum = 0;
    for (std::size_t u = 0; u < plan_.units.size(); ++u) {
      const Unit& unit = plan_.units[u];
      if (!journal_.has(u))
        sum += static_cast<double>(plan_.passes[unit.pass].evaluations()) * static_cast<double>(unit.pixel_count) *
               static_cast<double>(unit.replicate_count);
    }
    return sum;
  }

  void work() {
    try {
      UnitEvaluator evaluator(plan_, references_, catalogue_.samplers);
      for (std::size_t u = next_++; u < plan_.units.size() && !stop(); u = next_++) {
        if (journal_.has(u)) continue;
        const auto parts = evaluator.evaluate(plan_.units[u], [&](double samples) {
          progress_.advance(samples);
          return !stop();
        });
        if (!parts.empty()) journal_.append(u, encode_parts(parts));
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      failed_ = true;
    }
  }
  bool stop() const { return failed_ || interrupted(); }

  const Plan& plan_;
  std::span<const Reference> references_;
  const Catalogue& catalogue_;
  Journal& journal_;
  Progress progress_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> failed_ = false;
  std::mutex mutex_;
  std::exception_ptr failure_;
};

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
  if (options.overwrite) folder.remove_results();
  Journal journal(folder.path(), {run_hash(spec, plan), version(), isa_class(active_isa())}, options.overwrite);
  if (journal.dropped_bytes() > 0 && !options.quiet) {
    message("halfslope: {} bytes at the journal's end were damaged by an interruption; those units are done again\n",
            journal.dropped_bytes());
  }
  const std::vector<Reference> references =
      make_references(plan, catalogue.samplers, {options.threads, options.quiet, default_cache()});
  if (journal.size() < plan.units.size()) {
    Runner(plan, references, catalogue, journal, options.quiet, spec.name).run(options.threads);
  } else if (!options.quiet) {
    message("{}: everything was measured already; the tables are written anew\n", spec.name);
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
  for (const CellResult& cell : outcome.results.cells) outcome.invalid_cells += cell.statistics.invalid ? 1 : 0;
  const auto write = [&](const char* name, const std::string& text) {
    if (!text.empty()) write_file_atomically(folder.path(name), text);
  };
  write_reference_images(folder.path(), plan, references);
  write("rates.csv", rates_csv(outcome.results));
  write("tails.csv", tails_csv(outcome.results));
  write("regions.csv", regions_csv(outcome.results));
  write("convergence.csv", convergence_csv(outcome.results));
  write("manifest.json", manifest_json(spec, plan, outcome.results, references, started));
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
    std::error_code ignored;  // of an earlier run that asked for some
    std::filesystem::remove(folder.path("discrepancy.csv"), ignored);
  }
  return outcome;
}

void note_finished_work(Plan& plan, const Spec& spec, const Catalogue& catalogue, const std::filesystem::path& out) {
  for (std::string& line : describe_cached_references(plan, catalogue.samplers, default_cache()))
    plan.skips.push_back(std::move(line));
  if (!std::filesystem::exists(out / "journal")) return;
  try {
    const RunFolder folder(out);
    const Journal journal(folder.path(), {run_hash(spec, plan), version(), isa_class(active_isa())}, false);
    plan.skips.push_back(fmt::format("{} of {} units of work are in {}: not measured again", journal.size(),
                                     plan.units.size(), (out / "journal").string()));
  } catch (const Error& error) {
    // Another experiment's journal leaves nothing to skip; a folder that is busy cannot be looked into.
    if (error.code() != ExitCode::kBadInput) plan.skips.push_back(error.what());
  }
}

std::string describe_plan(const Spec& spec, const Plan& plan, const Catalogue& catalogue) {
  const auto count = [](auto n, const char* one, const char* many) {
    return fmt::format("{} {}", n, n == 1 ? one : many);
  };
  std::string text = fmt::format("{}: {} from {} in {} of work, {:.3g} integrand evaluations\n", spec.name,
                                 count(plan.cells.size(), "cell", "cells"), count(plan.passes.size(), "pass", "passes"),
                                 count(plan.units.size(), "unit", "units"), plan.evaluations());
  for (const Pass& pass : plan.passes) {
    const PlannedScene& scene = plan.scenes[pass.scene];
    std::vector<std::string> names;
    for (const std::size_t e : pass.estimators) names.push_back(scene.estimators[e].name);
    const int dims = pass.allocation.layout(scene.source->techniques()).dims();
    text += fmt::format("  {}, {}, {}: {} at N = {}{}, {} x {}, {}\n", scene.name, to_string(pass.precision),
                        pass.sampler, fmt::join(names, " + "), pass.samples.front(),
                        pass.samples.size() > 1 ? fmt::format(" … {}", pass.samples.back()) : "",
                        count(scene.pixels.size(), "pixel", "pixels"),
                        count(pass.replicates, "replicate", "replicates"), count(dims, "dimension", "dimensions"));
  }
  text += describe_measures(plan.measures);
  const auto references = describe_references(plan, catalogue.samplers);
  if (!references.empty()) text += "references:\n";
  for (const auto& line : references) text += "  " + line + "\n";
  text += "skipped:\n";
  for (const auto& skip : plan.skips) text += "  " + skip + "\n";
  return text;
}

}  // namespace halfslope
