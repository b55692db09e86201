// The idea of an integral: what an analytic scene and a pixel of a rendered one both are.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/layout.h"
#include "core/point_block.h"
#include "core/regularity.h"
#include "core/term_block.h"

namespace halfslope {

/// A way to draw samples, by name, and the dimensions that one sample takes.
struct Technique {
  std::string name;
  Layout layout;
  std::string misses = {};  ///< what contributes and its samples never reach, in words; empty: they reach all
};

/// As a TechniqueCall's technique: a path, with a sample of each technique in `set` at every vertex.
inline constexpr int kPath = -1;

/// Which samples to take: `technique` at the dimensions from `first_dim` of each point, written to `slot`, with the
/// densities of the techniques in `set` (indices into the source's techniques).
struct TechniqueCall {
  int technique = 0, first_dim = 0, slot = 0;
  std::span<const int> set;
};

/// One integral: f and the techniques that sample it, in one measure throughout. Made for one thread, which may prepare
/// itself when it is first sampled.
class Integral {
 public:
  virtual ~Integral() = default;
  /// Draws one sample at each point of the block and writes its terms.
  virtual void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<float>& terms) const = 0;
  virtual void sample(const TechniqueCall& call, const PointBlock& points, TermBlock<double>& terms) const = 0;
};

using Color = std::array<double, 3>;

/// An integral in one variable x for quadrature: what its techniques' exact variances are computed from.
struct ExactDensities {
  /// Ascending, the domain's ends among them: f and every density are smooth between, and no peak lies far from one.
  std::vector<double> breaks;
  /// f at x, inside an interval of them; pdfs[t] receives the density of technique t of the source.
  std::function<double(double x, std::span<double> pdfs)> evaluate;
};

/// A pixel as an integral: `constant` is what is known without sampling (an emitter seen directly, background), and
/// `integral` is null where nothing else is to be added.
struct PixelIntegral {
  Color constant = {0, 0, 0};
  std::unique_ptr<Integral> integral;
};

/// A scene as the engine sees it: width × height pixels of `channels` integrals each, and how they may be sampled.
class IntegralSource {
 public:
  virtual ~IntegralSource() = default;
  virtual int width() const { return 1; }
  virtual int height() const { return 1; }
  int pixels() const { return width() * height(); }
  /// Whether the pixels are an image, which could be of any size.
  virtual bool takes_resolution() const { return false; }
  /// 1 where every channel is equal.
  virtual int channels() const { return 1; }
  virtual std::span<const Technique> techniques() const = 0;
  /// The techniques that draw references, ascending: they suffice to reach all that contributes.
  virtual std::vector<int> reference_techniques() const {
    std::vector<int> all(techniques().size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  /// Where each sample is a path: its shape. Its terms are one that every heuristic adds whole, then one of each
  /// technique for each vertex; N counts paths.
  virtual const PathShape* path() const { return nullptr; }
  /// Pixel y · width + x, rows from the top.
  virtual PixelIntegral pixel(int index) const = 0;
  /// The exact value of the pixel, constant part included, where it is known in closed form.
  virtual std::optional<Color> closed_form(int /*pixel*/) const { return std::nullopt; }
  /// The variance of f at a uniform point, of a scene of one integral, where it is known; infinity where f² has no
  /// integral: then an estimate's mean squared error does not exist, and nothing that estimates it is reported.
  virtual std::optional<double> variance() const { return std::nullopt; }
  /// How smooth f is at a uniform point, of a scene whose only technique draws one.
  virtual Regularity regularity() const { return Regularity::kSquareIntegrable; }
  /// f and the densities of techniques(), of a scene of one integral that can be said in one variable.
  virtual std::optional<ExactDensities> exact_densities() const { return std::nullopt; }
  /// Parts of the image to report on beside the whole, and the part a pixel is in (an index into them).
  virtual std::vector<std::string> regions() const { return {}; }
  virtual int region(int /*pixel*/) const { return 0; }
  /// What this scene lets us skip, and why: lines for --dry-run.
  virtual std::vector<std::string> skips() const { return {}; }
  /// All that determines the integrals, for the cache of references.
  virtual std::string fingerprint() const = 0;
};

}  // namespace halfslope
