#include "estimators/path_transport.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/kernel_library.h"
#include "estimators/camera.h"
#include "estimators/kernels.h"
#include "estimators/skip_worth.h"
#include "scenes/fingerprint.h"

namespace halfslope {
namespace {

/// The light techniques, in the order of the source's techniques.
constexpr std::array kLightTechniques = {TransportTechnique::kLight,
                                         TransportTechnique::kLightPower,
                                         TransportTechnique::kLightBvh,
                                         TransportTechnique::kLightSolidAngle,
                                         TransportTechnique::kLightPowerSolidAngle,
                                         TransportTechnique::kLightBvhSolidAngle};

/// Paths through one pixel. Belongs to one thread.
class PixelPaths final : public Integral {
 public:
  PixelPaths(const LazyTransport& transport, Camera camera, std::span<const float> filter, const PathOptions& options,
             int channels, const PathDims& dims)
      : transport_(transport), camera_(camera), filter_(filter), options_(options), channels_(channels), dims_(dims) {}

  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<float>& terms) const override {
    trace(f32_, call, points, terms, kernels_.paths_f32);
  }
  void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<double>& terms) const override {
    trace(f64_, call, points, terms, kernels_.paths_f64);
  }

 private:
  template <class T>
  void trace(std::optional<CameraData<T>>& camera, const TechniqueCall& call, const PointBlock& points,
             TermBlock<T>& terms, void (*kernel)(const PathCall<T>&)) const {
    if (!camera) camera = camera_data<T>(camera_, filter_);
    const auto dims = static_cast<std::size_t>(points.dims());
    high_.resize(dims), low_.resize(dims);
    for (std::size_t d = 0; d < dims; ++d) {
      high_[d] = points.high(static_cast<int>(d));
      low_[d] = points.low(static_cast<int>(d));
    }
    const TransportData<T>& data = transport_.of<T>();
    kernel({&data.scene(), &*camera, channels_, options_.max_depth, options_.rr_depth,
            way_of(kLightTechniques[static_cast<std::size_t>(call.set[0])]), dims_, high_.data(), low_.data(),
            points.stride(), terms.stride(), terms.data()});
  }

  const LazyTransport& transport_;
  Camera camera_;
  std::span<const float> filter_;
  PathOptions options_;
  int channels_;
  PathDims dims_;
  const EstimatorKernels& kernels_ = kernels<EstimatorKernels>();
  mutable std::optional<CameraData<float>> f32_;
  mutable std::optional<CameraData<double>> f64_;
  mutable std::vector<const std::uint32_t*> high_, low_;
};

}  // namespace

PathTransport::PathTransport(Scene scene, int width, int height, const PathOptions& options)
    : scene_(with_lights(std::move(scene))),
      width_(width),
      height_(height),
      channels_(is_grey(scene_) ? 1 : 3),
      options_(options),
      intersector_(scene_),
      tracing_(tracing_of(scene_, intersector_)),
      filter_(inverse_filter(scene_.sensor)),
      chooses_(chooses_lobes(scene_)),
      transport_(scene_, tracing_, true) {
  const bool choice = transport_.chosen() > 1;
  for (const TransportTechnique light : kLightTechniques) {
    techniques_.push_back({kTransportNames[static_cast<std::size_t>(light)], choice ? Layout{{1, 2}} : Layout{{2}},
                           missed_by_lights(scene_)});
  }
  techniques_.push_back({"bsdf", chooses_ ? Layout{{1, 2}} : Layout{{2}}});
  if (!filter_.empty()) shape_.start.groups.push_back(2);
  if (scene_.sensor.kind == Sensor::Kind::kThinLens && scene_.sensor.aperture_radius > 0) {
    shape_.start.groups.push_back(2);
  }
  shape_.vertices = options_.max_depth - 1;
  if (options_.rr_depth > 0) shape_.each.groups.push_back(1);

  // Where the numbers of a path stand: as shape_ and the techniques' layouts have them.
  std::int32_t next = 0;
  const auto take = [&](std::int32_t count) { return std::exchange(next, next + count); };
  if (!filter_.empty()) dims_.film = take(2);
  if (scene_.sensor.kind == Sensor::Kind::kThinLens && scene_.sensor.aperture_radius > 0) dims_.lens = take(2);
  dims_.first_vertex = next;
  next = 0;
  if (transport_.chosen() > 1) dims_.choice = take(1);
  dims_.light = take(2);
  if (chooses_) dims_.lobe = take(1);
  dims_.bsdf = take(2);
  if (options_.rr_depth > 0) dims_.roulette = take(1);
  dims_.per_vertex = next;
}

std::vector<int> PathTransport::reference_techniques() const { return {0, static_cast<int>(techniques_.size()) - 1}; }

PixelIntegral PathTransport::pixel(int index) const {
  PixelIntegral result;
  const Camera camera = camera_of(scene_.sensor, tracing_, index % width_, index / width_, width_, height_);
  result.integral = std::make_unique<PixelPaths>(transport_, camera, filter_, options_, channels_, dims_);
  return result;
}

// Parts of the image: what the ray through a pixel's centre sees.
std::vector<std::string> PathTransport::regions() const {
  std::vector<std::string> names = {"background"};
  for (const Primitive& shape : scene_.primitives) names.push_back(shape.id);
  return names;
}

int PathTransport::region(int pixel) const {
  return 1 + intersector_.first(scene_.sensor.ray(pixel % width_, pixel / width_, width_, height_)).primitive;
}

std::vector<std::string> PathTransport::skips() const {
  std::vector<std::string> lines = {"intersection: " + intersector_.why()};
  lines.push_back(fmt::format("paths: max_depth {}{}", options_.max_depth,
                              options_.rr_depth > 0 ? fmt::format(", Russian roulette from depth {}", options_.rr_depth)
                                                    : ", no Russian roulette: no dimension for it"));
  if (transport_.chosen() == 1)
    lines.push_back("one light: no light choice, and no dimension for it" + worth(kWorthNoLightChoice));
  if (!chooses_) lines.push_back("no BSDF chooses between lobes: no dimension for that");
  if (filter_.empty())
    lines.push_back("no reconstruction filter: each pixel is its ray, and takes no dimension for it");
  if (channels_ == 1) lines.push_back("grey scene: one channel" + worth(kWorthOneChannel));
  return lines;
}

std::string PathTransport::fingerprint() const {
  return fmt::format("paths {}x{} depth {} roulette {}\n{}", width_, height_, options_.max_depth, options_.rr_depth,
                     scene_fingerprint(scene_));
}

}  // namespace halfslope
