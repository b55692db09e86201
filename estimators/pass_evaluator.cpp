#include "estimators/pass_evaluator.h"

#include <algorithm>
#include <numeric>
#include <type_traits>

#include "core/kernel_library.h"

namespace halfslope {
namespace {

/// The most samples of a block: its terms stay in the first cache for a pair of techniques, its points beside them.
constexpr std::uint64_t kBlock = 32;
/// Of paths, which have more of both.
constexpr std::uint64_t kPathBlock = 8;

}  // namespace

template <class T>
PassEvaluator<T>::PassEvaluator(std::unique_ptr<Sampler> sampler, std::span<const Technique> techniques,
                                Allocation allocation, std::vector<Heuristic> heuristics,
                                std::vector<std::uint64_t> rounds, int channels)
    : sampler_(std::move(sampler)),
      allocation_(std::move(allocation)),
      heuristics_(std::move(heuristics)),
      rounds_(std::move(rounds)),
      channels_(channels),
      block_(allocation_.path ? kPathBlock : kBlock),
      layout_(allocation_.layout(techniques)),
      kernels_(kernels<EstimatorKernels>()) {
  for (const int count : allocation_.counts) counts_.push_back(static_cast<T>(count));
  if (allocation_.one_sample) {
    one_sample_.emplace(allocation_, techniques);
    for (std::size_t i = 0; i < counts_.size(); ++i) slot_technique_.push_back(static_cast<int>(i));
  } else if (allocation_.path) {
    calls_.push_back({kPath, 0, 0, allocation_.techniques});
    slot_technique_.push_back(-1);
    for (int vertex = 0; vertex < allocation_.path->vertices; ++vertex) {
      for (std::size_t i = 0; i < counts_.size(); ++i) slot_technique_.push_back(static_cast<int>(i));
    }
  } else {
    int dim = 0;
    for (std::size_t i = 0; i < allocation_.techniques.size(); ++i) {
      const int technique = allocation_.techniques[i];
      for (int j = 0; j < allocation_.counts[i]; ++j) {
        calls_.push_back({technique, dim, static_cast<int>(calls_.size()), allocation_.techniques});
        slot_technique_.push_back(static_cast<int>(i));
        dim += techniques[static_cast<std::size_t>(technique)].layout.dims();
      }
    }
  }
  for (const Heuristic& heuristic : heuristics_) {
    if (is_fold(heuristic.kind)) folds_.push_back(heuristic);
    progressive_ |= heuristic.kind == HeuristicKind::kOptimalProgressive;
  }
  std::size_t outputs = folds_.size() * static_cast<std::size_t>(channels_);
  if (folds_.size() < heuristics_.size()) {
    optimal_.emplace(allocation_.counts, channels_, OptimalSolver::tolerance(std::is_same_v<T, float>));
    outputs += optimal_->sums();
    totals_.resize(optimal_->sums() * kLanes);
  }
  values_.resize(outputs * kBlock * kLanes);
  for (std::size_t o = 0; o < outputs; ++o) outputs_.push_back(values_.data() + o * kBlock * kLanes);
  sums_.resize(outputs * kLanes);
  compensations_.resize(outputs * kLanes);
  estimates_.resize(heuristics_.size() * static_cast<std::size_t>(channels_) * rounds_.size() * kLanes);
}

template <class T>
void PassEvaluator<T>::run(const Integral& integral, StreamKey key, std::uint32_t pixel, std::uint32_t replicate) {
  PointRequest request = {0, &layout_, key, pixel, replicate, std::is_same_v<T, double>};
  const bool sequence = sampler_->info().sequence;
  if (sequence) {
    // A sequence's smaller N are prefixes of the largest: one pass gives them all.
    request.count = rounds_.back();
    sampler_->prepare(request);
    clear();
  }
  std::uint64_t done = 0;
  for (std::size_t n = 0; n < rounds_.size(); ++n) {
    if (!sequence) {
      request.count = rounds_[n];
      sampler_->prepare(request);
      clear();
      done = 0;
    }
    sum_to(integral, done, rounds_[n]);
    done = rounds_[n];
    report(n);
  }
}

// Stops where the optimal weights are solved anew.
template <class T>
void PassEvaluator<T>::sum_to(const Integral& integral, std::uint64_t begin, std::uint64_t end) {
  while (progressive_ && optimal_->next_update(begin) <= end) {
    const std::uint64_t update = optimal_->next_update(begin);
    sum_points(integral, begin, update);
    optimal_->update(regression_totals(), update);
    begin = update;
  }
  sum_points(integral, begin, end);
}

template <class T>
void PassEvaluator<T>::make_points(StreamKey key, std::uint32_t pixel, std::uint32_t replicate) {
  constexpr bool kLowWords = std::is_same_v<T, double>;
  const auto make = [&](std::uint64_t count) {
    sampler_->prepare({count, &layout_, key, pixel, replicate, kLowWords});
    for (std::uint64_t first = 0; first < count; first += block_) {
      points_.reset(layout_.dims(), static_cast<int>(std::min(block_, count - first)), kLowWords);
      sampler_->fill(first, points_);
    }
  };
  if (sampler_->info().sequence) return make(rounds_.back());
  for (const std::uint64_t count : rounds_) make(count);
}

template <class T>
void PassEvaluator<T>::clear() {
  std::fill_n(sums_.data(), sums_.size(), 0.0);
  std::fill_n(compensations_.data(), compensations_.size(), 0.0);
  if (optimal_) optimal_->clear();
}

template <class T>
void PassEvaluator<T>::draw(const Integral& integral) {
  terms_.reset(static_cast<int>(slot_technique_.size()), channels_, static_cast<int>(allocation_.techniques.size()),
               points_.samples());
  if (one_sample_) one_sample_->sample(integral, points_, terms_);
  for (const TechniqueCall& call : calls_) integral.sample(call, points_, terms_);
}

template <class T>
void PassEvaluator<T>::sum_points(const Integral& integral, std::uint64_t begin, std::uint64_t end) {
  for (std::uint64_t first = begin; first < end; first += block_) {
    const int samples = static_cast<int>(std::min(block_, end - first));
    points_.reset(layout_.dims(), samples, std::is_same_v<T, double>);
    sampler_->fill(first, points_);
    draw(integral);
    const FoldCall<T> fold = {
        terms_.data(),
        terms_.stride(),
        points_.stride(),
        static_cast<int>(slot_technique_.size()),
        channels_,
        static_cast<int>(allocation_.techniques.size()),
        slot_technique_.data(),
        counts_.data(),
        folds_.data(),
        static_cast<int>(folds_.size()),
        outputs_.data(),
        optimal_ ? outputs_.data() + folds_.size() * static_cast<std::size_t>(channels_) : nullptr};
    if constexpr (std::is_same_v<T, float>) {
      kernels_.fold_f32(fold);
    } else {
      kernels_.fold_f64(fold);
    }
    const auto outputs = static_cast<int>(outputs_.size());
    if constexpr (std::is_same_v<T, float>) {
      kernels_.accumulate_f32(outputs_.data(), outputs, samples, sums_.data(), compensations_.data());
    } else {
      kernels_.accumulate_f64(outputs_.data(), outputs, samples, sums_.data(), compensations_.data());
    }
  }
}

template <class T>
std::span<const double> PassEvaluator<T>::regression_totals() {
  const std::size_t first = sums_.size() - totals_.size();
  for (std::size_t i = 0; i < totals_.size(); ++i) totals_[i] = sums_[first + i] - compensations_[first + i];
  return totals_;
}

template <class T>
void PassEvaluator<T>::report(std::size_t n) {
  const auto rounds = static_cast<double>(rounds_[n]);
  // A fold's weights are over counts; one sample's over probabilities, which are those divided by their sum.
  const double scale = allocation_.one_sample ? std::accumulate(counts_.begin(), counts_.end(), 0.0) : 1;
  std::size_t fold = 0;
  for (std::size_t h = 0; h < heuristics_.size(); ++h) {
    double* out = const_cast<double*>(estimates(h, n, 0));
    if (heuristics_[h].kind == HeuristicKind::kOptimal) {
      optimal_->direct(regression_totals(), rounds_[n], out);
    } else if (heuristics_[h].kind == HeuristicKind::kOptimalProgressive) {
      optimal_->progressive(regression_totals(), rounds_[n], out);
    } else {
      const std::size_t lanes = static_cast<std::size_t>(channels_) * kLanes, first = fold++ * lanes;
      for (std::size_t l = 0; l < lanes; ++l) out[l] = (sums_[first + l] - compensations_[first + l]) / rounds * scale;
    }
  }
}

template class PassEvaluator<float>;
template class PassEvaluator<double>;

}  // namespace halfslope
