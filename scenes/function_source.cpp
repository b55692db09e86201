#include "scenes/function_source.h"

#include <type_traits>

#include "core/coordinates.h"
#include "scenes/pairs.h"

namespace halfslope {
namespace {

class FunctionIntegral final : public Integral {
 public:
  FunctionIntegral(const FunctionSource::Function& f, int dims, int pixel) : f_(f), dims_(dims), pixel_(pixel) {}
  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<float>& terms) const override {
    evaluate(call, points, terms);
  }
  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<double>& terms) const override {
    evaluate(call, points, terms);
  }

 private:
  template <class T>
  void evaluate(const TechniqueCall& call, const PointBlock& points, TermBlock<T>& terms) const {
    std::vector<double> x(static_cast<std::size_t>(dims_));
    T *values = terms.value(call.slot, 0), *densities = terms.pdf(call.slot, 0);
    for (std::size_t i = 0; i < points.stride(); ++i) {
      for (int d = 0; d < dims_; ++d) {
        const std::uint32_t* low = points.low(call.first_dim + d);
        T coordinate;
        to_coordinates<T>(points.high(call.first_dim + d) + i, low ? low + i : nullptr, 1, &coordinate);
        x[static_cast<std::size_t>(d)] = static_cast<double>(coordinate);
      }
      values[i] = static_cast<T>(f_(x, pixel_));
      densities[i] = 1;
    }
  }

  const FunctionSource::Function& f_;
  int dims_, pixel_;
};

}  // namespace

FunctionSource::FunctionSource(std::string fingerprint, int dims, Function f, std::optional<double> exact, int width,
                               int height)
    : fingerprint_(std::move(fingerprint)),
      f_(std::move(f)),
      exact_(exact),
      width_(width),
      height_(height),
      techniques_{{"mean", pairs(dims)}} {}

PixelIntegral FunctionSource::pixel(int index) const {
  return {{0, 0, 0}, std::make_unique<FunctionIntegral>(f_, techniques_.front().layout.dims(), index)};
}

std::optional<Color> FunctionSource::closed_form(int) const {
  return exact_ ? std::optional(Color{*exact_, *exact_, *exact_}) : std::nullopt;
}

}  // namespace halfslope
