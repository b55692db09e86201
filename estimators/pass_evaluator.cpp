#include "estimators/pass_evaluator.h"

#include <algorithm>
#include <type_traits>

#include "core/kernel_library.h"

namespace halfslope {
namespace {

/// Samples of a block: its terms stay in the first cache for a pair of techniques, its points beside them.
constexpr std::uint64_t kBlock = 32;

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
      layout_(allocation_.layout(techniques)),
      kernels_(kernels<EstimatorKernels>()) {
  int dim = 0;
  for (std::size_t i = 0; i < allocation_.techniques.size(); ++i) {
    const int technique = allocation_.techniques[i];
    for (int j = 0; j < allocation_.counts[i]; ++j) {
      calls_.push_back({technique, dim, static_cast<int>(calls_.size()), allocation_.techniques});
      slot_technique_.push_back(static_cast<int>(i));
      dim += techniques[static_cast<std::size_t>(technique)].layout.dims();
    }
    counts_.push_back(static_cast<T>(allocation_.counts[i]));
  }
  const std::size_t outputs = heuristics_.size() * static_cast<std::size_t>(channels_);
  values_.resize(outputs * kBlock * kLanes);
  for (std::size_t o = 0; o < outputs; ++o) outputs_.push_back(values_.data() + o * kBlock * kLanes);
  sums_.resize(outputs * kLanes);
  compensations_.resize(outputs * kLanes);
  estimates_.resize(outputs * rounds_.size() * kLanes);
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
    sum_points(integral, done, rounds_[n]);
    done = rounds_[n];
    report(n);
  }
}

template <class T>
void PassEvaluator<T>::make_points(StreamKey key, std::uint32_t pixel, std::uint32_t replicate) {
  constexpr bool kLowWords = std::is_same_v<T, double>;
  const auto make = [&](std::uint64_t count) {
    sampler_->prepare({count, &layout_, key, pixel, replicate, kLowWords});
    for (std::uint64_t first = 0; first < count; first += kBlock) {
      points_.reset(layout_.dims(), static_cast<int>(std::min(kBlock, count - first)), kLowWords);
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
}

template <class T>
void PassEvaluator<T>::sum_points(const Integral& integral, std::uint64_t begin, std::uint64_t end) {
  for (std::uint64_t first = begin; first < end; first += kBlock) {
    const int samples = static_cast<int>(std::min(kBlock, end - first));
    points_.reset(layout_.dims(), samples, std::is_same_v<T, double>);
    sampler_->fill(first, points_);
    terms_.reset(static_cast<int>(calls_.size()), channels_, static_cast<int>(allocation_.techniques.size()), samples);
    for (const TechniqueCall& call : calls_) integral.sample(call, points_, terms_);
    const FoldCall<T> fold = {terms_.data(),
                              terms_.stride(),
                              points_.stride(),
                              static_cast<int>(calls_.size()),
                              channels_,
                              static_cast<int>(allocation_.techniques.size()),
                              slot_technique_.data(),
                              counts_.data(),
                              heuristics_.data(),
                              static_cast<int>(heuristics_.size()),
                              outputs_.data()};
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
void PassEvaluator<T>::report(std::size_t n) {
  const auto rounds = static_cast<double>(rounds_[n]);
  for (std::size_t h = 0; h < heuristics_.size(); ++h) {
    for (int c = 0; c < channels_; ++c) {
      const std::size_t o = h * static_cast<std::size_t>(channels_) + static_cast<std::size_t>(c);
      double* out = const_cast<double*>(estimates(h, n, c));
      for (std::size_t l = 0; l < kLanes; ++l)
        out[l] = (sums_[o * kLanes + l] - compensations_[o * kLanes + l]) / rounds;
    }
  }
}

template class PassEvaluator<float>;
template class PassEvaluator<double>;

}  // namespace halfslope
