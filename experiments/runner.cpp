#include "experiments/runner.h"

#include <tbb/task_group.h>

#include <chrono>

#include "core/error.h"
#include "experiments/interrupt.h"
#include "experiments/parallel.h"

namespace halfslope {

std::size_t finished_units(const Plan& plan, const Journal& journal) {
  std::size_t count = 0;
  for (std::size_t u = 0; u < plan.units.size(); ++u) count += journal.has(u) ? 1 : 0;
  return count;
}

void check_interrupt(const Plan& plan, const Journal& journal) {
  if (!interrupted()) return;
  fail(ExitCode::kInterrupted, "interrupted; {} of {} units are done: run the same command again to go on",
       finished_units(plan, journal), plan.units.size());
}

Runner::Runner(const Plan& plan, std::span<const Reference> references, const SamplerCatalogue& samplers,
               Journal& journal, Progress& progress, int threads)
    : plan_(plan),
      references_(references),
      samplers_(samplers),
      journal_(journal),
      progress_(progress),
      threads_(threads > 0 ? threads : tbb::info::default_concurrency()),
      work_(plan.passes.size()) {}

void Runner::run(std::span<const std::uint64_t> units) {
  next_ = 0;
  with_threads(threads_, [&](int count) {
    tbb::task_group group;
    for (int t = 0; t < count; ++t) group.run([&] { evaluate(units); });
    group.wait();
  });
  if (failure_) std::rethrow_exception(failure_);
  check_interrupt(plan_, journal_);
}

void Runner::evaluate(std::span<const std::uint64_t> units) {
  try {
    UnitEvaluator evaluator(plan_, references_, samplers_);
    for (std::size_t i = next_++; i < units.size() && !stop(); i = next_++) {
      if (journal_.has(units[i])) continue;
      const Unit& unit = plan_.units[units[i]];
      const auto start = std::chrono::steady_clock::now();
      double evaluations = 0;
      const auto parts = evaluator.evaluate(unit, [&](double samples) {
        evaluations += samples;
        progress_.advance(samples);
        return !stop();
      });
      if (!parts.empty()) journal_.append(units[i], encode_parts(parts));
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      const std::lock_guard lock(mutex_);
      work_[unit.pass].seconds += seconds.count();
      work_[unit.pass].evaluations += evaluations;
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::current_exception();
    failed_ = true;
  }
}

bool Runner::stop() const { return failed_ || interrupted(); }

}  // namespace halfslope
