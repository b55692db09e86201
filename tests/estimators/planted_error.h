// A source of paths that is wrong on purpose, so that it is seen whether a test would find it.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "estimators/path_transport.h"

namespace halfslope {

/// Where a BSDF takes a wrong density at the first vertex of paths: for directions that it is asked about, whose
/// weights then are wrong; or for those that it draws, whose contributions f/p are wrong as well.
enum class WrongPdf { kNowhere, kEvaluated, kSampled };

/// The paths of another source, with the BSDF's density at the first vertex times `factor`.
class PlantedError final : public IntegralSource {
 public:
  PlantedError(const PathTransport& right, WrongPdf where, double factor)
      : right_(right), where_(where), factor_(factor) {}

  int width() const override { return right_.width(); }
  int height() const override { return right_.height(); }
  int channels() const override { return right_.channels(); }
  std::span<const Technique> techniques() const override { return right_.techniques(); }
  const PathShape* path() const override { return right_.path(); }
  std::string fingerprint() const override { return right_.fingerprint(); }
  PixelIntegral pixel(int index) const override {
    PixelIntegral pixel = right_.pixel(index);
    if (pixel.integral) pixel.integral = std::make_unique<Wrong>(std::move(pixel.integral), where_, factor_);
    return pixel;
  }

 private:
  class Wrong final : public Integral {
   public:
    Wrong(std::unique_ptr<Integral> right, WrongPdf where, double factor)
        : right_(std::move(right)), where_(where), factor_(factor) {}
    void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<float>& terms) const override {
      plant(call, points, terms);
    }
    void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<double>& terms) const override {
      plant(call, points, terms);
    }

   private:
    template <class T>
    void plant(const TechniqueCall& call, const PointBlock& points, TermBlock<T>& terms) const {
      right_->sample(call, points, terms);
      if (where_ == WrongPdf::kNowhere) return;
      // Slot 0 is what only one technique finds; then the light's and the BSDF's of the first vertex.
      T* pdf = terms.pdf(where_ == WrongPdf::kEvaluated ? 1 : 2, 1);
      for (std::size_t i = 0; i < terms.stride(); ++i) pdf[i] *= static_cast<T>(factor_);
      for (int c = 0; where_ == WrongPdf::kSampled && c < terms.channels(); ++c) {
        T* value = terms.value(2, c);
        for (std::size_t i = 0; i < terms.stride(); ++i) value[i] /= static_cast<T>(factor_);
      }
    }
    std::unique_ptr<Integral> right_;
    WrongPdf where_;
    double factor_;
  };

  const PathTransport& right_;
  WrongPdf where_;
  double factor_;
};

}  // namespace halfslope
