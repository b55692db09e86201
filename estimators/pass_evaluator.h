// One pass over one integral: points → terms → every heuristic → estimates at every N on the way.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/integral.h"
#include "estimators/estimator.h"
#include "estimators/kernels.h"
#include "estimators/one_sample.h"
#include "estimators/optimal.h"
#include "samplers/sampler.h"

namespace halfslope {

/// Evaluates estimators that share an allocation, on kLanes replicates of one integral at a time. Holds a thread's
/// buffers, whose size depends on the pass only. T is the precision: float or double.
template <class T>
class PassEvaluator {
 public:
  /// `rounds` are the numbers of rounds to report, ascending (N divided by the allocation's round()).
  PassEvaluator(std::unique_ptr<Sampler> sampler, std::span<const Technique> techniques, Allocation allocation,
                std::vector<Heuristic> heuristics, std::vector<std::uint64_t> rounds, int channels);

  /// Estimates of `integral` for replicates `replicate` … + kLanes − 1 of `pixel`. Afterwards estimates(h, n, c) holds
  /// kLanes numbers: heuristic h, the n-th of `rounds`, channel c.
  void run(const Integral& integral, StreamKey key, std::uint32_t pixel, std::uint32_t replicate);
  const double* estimates(std::size_t heuristic, std::size_t n, int channel) const {
    return estimates_.data() + ((heuristic * rounds_.size() + n) * static_cast<std::size_t>(channels_) +
                                static_cast<std::size_t>(channel)) *
                                   kLanes;
  }

  /// Makes the points that run() takes, block by block as it does, and evaluates nothing: what points alone cost.
  void make_points(StreamKey key, std::uint32_t pixel, std::uint32_t replicate);

 private:
  void sum_to(const Integral& integral, std::uint64_t begin, std::uint64_t end);
  void sum_points(const Integral& integral, std::uint64_t begin, std::uint64_t end);
  void draw(const Integral& integral);
  std::span<const double> regression_totals();
  void report(std::size_t n);
  void clear();

  std::unique_ptr<Sampler> sampler_;
  Allocation allocation_;
  std::vector<Heuristic> heuristics_, folds_;  ///< all, and those that are folds
  std::vector<std::uint64_t> rounds_;
  int channels_;
  std::uint64_t block_;  ///< samples that are worked on together
  Layout layout_;
  std::vector<TechniqueCall> calls_;
  std::vector<int> slot_technique_;
  std::vector<T> counts_;
  PointBlock points_;
  TermBlock<T> terms_;
  AlignedBuffer<T> values_;
  std::vector<T*> outputs_;
  AlignedBuffer<double> sums_, compensations_;
  std::vector<double> estimates_;
  std::optional<OneSample<T>> one_sample_;  ///< where the allocation is
  std::optional<OptimalSolver> optimal_;    ///< where some heuristic is no fold
  bool progressive_ = false;                ///< whether one is solved on the way
  std::vector<double> totals_;              ///< of the regression
  const EstimatorKernels& kernels_;
};

extern template class PassEvaluator<float>;
extern template class PassEvaluator<double>;

}  // namespace halfslope
