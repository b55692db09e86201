// Units of work in parallel, into the journal.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <span>
#include <vector>

#include "experiments/journal.h"
#include "experiments/plan.h"
#include "experiments/progress.h"
#include "experiments/reference.h"
#include "experiments/unit.h"

namespace halfslope {

/// How many of the plan's units the journal has.
std::size_t finished_units(const Plan& plan, const Journal& journal);

/// Throws Error(kInterrupted), saying how far the run came, if a signal has come.
void check_interrupt(const Plan& plan, const Journal& journal);

/// What threads have done for one pass.
struct PassWork {
  double seconds = 0;      ///< summed over threads
  double evaluations = 0;  ///< of the integrand
};

class Runner {
 public:
  /// `threads`: 0 for every core.
  Runner(const Plan& plan, std::span<const Reference> references, const SamplerCatalogue& samplers, Journal& journal,
         Progress& progress, int threads);

  /// Takes those of the units that the journal does not have, in order, and journals them: every thread until none is
  /// left, one fails, or a signal comes. Throws what a thread threw, and Error(kInterrupted).
  void run(std::span<const std::uint64_t> units);

  /// Of this object's runs, pass by pass.
  const std::vector<PassWork>& work() const { return work_; }
  Progress& progress() const { return progress_; }
  Journal& journal() const { return journal_; }
  int threads() const { return threads_; }

 private:
  void evaluate(std::span<const std::uint64_t> units);
  bool stop() const;

  const Plan& plan_;
  std::span<const Reference> references_;
  const SamplerCatalogue& samplers_;
  Journal& journal_;
  Progress& progress_;
  const int threads_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> failed_ = false;
  std::mutex mutex_;  ///< of what follows
  std::exception_ptr failure_;
  std::vector<PassWork> work_;
};

}  // namespace halfslope
