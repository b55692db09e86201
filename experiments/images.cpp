#include "experiments/images.h"

#include <algorithm>
#include <map>

#include "core/error.h"
#include "core/random.h"

namespace halfslope {
namespace {

/// An image whose layers are filled integral by integral; a grey scene's one channel becomes three.
class Layers {
 public:
  explicit Layers(const IntegralSource& source)
      : channels_(static_cast<std::size_t>(source.channels())), pixels_(static_cast<std::size_t>(source.pixels())) {
    image_.width = source.width();
    image_.height = source.height();
  }
  /// Adds "R", "G", "B" (layer "") or "layer.R", …; `value(i)` of integral i, pixel-major.
  template <class Value>
  void add(const std::string& layer, Value value) {
    for (std::size_t c = 0; c < 3; ++c) {
      ExrImage::Channel channel;
      channel.name = (layer.empty() ? "" : layer + ".") + "RGB"[c];
      channel.values.reserve(pixels_);
      for (std::size_t p = 0; p < pixels_; ++p) {
        channel.values.push_back(static_cast<float>(value(p * channels_ + std::min(c, channels_ - 1))));
      }
      image_.channels.push_back(std::move(channel));
    }
  }
  ExrImage take() { return std::move(image_); }

 private:
  std::size_t channels_, pixels_;
  ExrImage image_;
};

bool has_picture(const PlannedScene& scene) {
  return scene.source->pixels() > 1 && scene.pixels.size() == static_cast<std::size_t>(scene.source->pixels());
}

}  // namespace

std::string path_component(const std::string& name) {
  std::string safe = name;
  std::replace(safe.begin(), safe.end(), '/', '_');
  constexpr std::size_t kLongest = 200;  // file systems take 255 bytes, and more may be joined to it
  if (safe.size() <= kLongest) return safe;
  const std::string hash = fmt::format("{:016x}-", hash_text(name));
  return hash + safe.substr(safe.size() - (kLongest - hash.size()));
}

void check_image_folders(const Spec& spec) {
  for (const auto& names : {spec.scenes, spec.samplers}) {
    std::map<std::string, std::string> folders;
    for (const std::string& name : names) {
      const auto [found, added] = folders.emplace(path_component(name), name);
      if (!added) {
        fail(ExitCode::kBadInput, "'{}' and '{}' would have their images in one folder, '{}'; rename a file",
             found->second, name, found->first);
      }
    }
  }
}

ExrImage picture(const IntegralSource& source, std::span<const double> values) {
  Layers layers(source);
  layers.add("", [&](std::size_t i) { return values[i]; });
  return layers.take();
}

ExrImage reference_image(const IntegralSource& source, const Reference& reference) {
  Layers layers(source);
  layers.add("", [&](std::size_t i) { return reference.value[i]; });
  layers.add("variance", [&](std::size_t i) { return reference.variance[i]; });
  layers.add("half_a", [&](std::size_t i) { return reference.half_a[i]; });
  layers.add("half_b", [&](std::size_t i) { return reference.half_b[i]; });
  return layers.take();
}

void write_cell_image(const std::filesystem::path& folder, const Plan& plan, const Cell& cell, const FoldedCell& folded,
                      const std::vector<Reference>& references) {
  const PlannedScene& scene = plan.scenes[cell.scene];
  const Reference& reference = references[cell.scene];
  const auto bias = [&](std::size_t i) { return folded.integrals[i].mean - reference.value[i]; };
  Layers layers(*scene.source);
  layers.add("", [&](std::size_t i) { return folded.integrals[i].mean; });
  if (!folded.data.infinite_variance) {
    if (folded.data.replicates > 1)
      layers.add("variance", [&](std::size_t i) { return folded.integrals[i].variance(); });
    layers.add("mse", [&](std::size_t i) { return folded.integrals[i].m2() + bias(i) * bias(i); });
  }
  layers.add("bias", bias);
  const auto path = folder / "images" / path_component(scene.name) / to_string(cell.precision) /
                    path_component(scene.estimators[cell.estimator].name) / path_component(cell.sampler);
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) fail(ExitCode::kIo, "{}: cannot be made: {}", path.string(), error.message());
  write_exr(path / (std::to_string(cell.samples) + ".exr"), layers.take());
}

void write_reference_images(const std::filesystem::path& folder, const Plan& plan,
                            const std::vector<Reference>& references) {
  const auto pictures = std::count_if(plan.scenes.begin(), plan.scenes.end(), has_picture);
  for (std::size_t s = 0; s < plan.scenes.size(); ++s) {
    const PlannedScene& scene = plan.scenes[s];
    if (!has_picture(scene)) continue;
    const std::string name = pictures == 1 ? "reference.exr" : "reference-" + path_component(scene.name) + ".exr";
    write_exr(folder / name, reference_image(*scene.source, references[s]));
  }
}

}  // namespace halfslope
