#include "experiments/image_reference.h"

#include <algorithm>
#include <cmath>

#include "analysis/compensated_sum.h"
#include "core/error.h"
#include "experiments/joined.h"

namespace halfslope {
namespace {

std::vector<std::string> channels_of(const ExrFile& file, const std::string& prefix) {
  std::vector<std::string> names;
  for (const char* channel : {"R", "G", "B"}) {
    if (file.find(prefix + channel)) names.push_back(prefix + channel);
  }
  if (names.size() == 3) return names;
  return file.find(prefix + "Y") ? std::vector<std::string>{prefix + "Y"} : std::vector<std::string>();
}

/// Layers that have R, G and B, or Y.
std::vector<std::string> layers_of(const ExrFile& file) {
  std::vector<std::string> layers;
  for (const ExrFile::Channel& channel : file.channels()) {
    const std::size_t dot = channel.name.rfind('.');
    if (dot == std::string::npos) continue;
    const std::string layer = channel.name.substr(0, dot);
    const bool known = std::ranges::find(layers, layer) != layers.end();
    if (!known && !channels_of(file, layer + ".").empty()) layers.push_back(layer);
  }
  return layers;
}

std::vector<double> read_values(const ExrFile& file, const std::vector<std::string>& channels) {
  const ExrImage image = file.read(channels);
  std::vector<double> values(channels.size() * image.channels.front().values.size());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const std::vector<float>& from = image.channels[c].values;
    for (std::size_t pixel = 0; pixel < from.size(); ++pixel) values[pixel * channels.size() + c] = from[pixel];
  }
  return values;
}

/// Of the layer's channels that stand beside the image's, in their order; empty unless all are there.
std::vector<double> read_layer(const ExrFile& file, const std::string& layer,
                               const std::vector<std::string>& channels) {
  std::vector<std::string> names;
  for (const std::string& channel : channels) {
    names.push_back(layer + "." + channel.substr(channel.rfind('.') + 1));
    if (!file.find(names.back())) return {};
  }
  return read_values(file, names);
}

std::vector<std::string> reference_channels(const ExrFile& file, const std::string& layer) {
  if (!layer.empty()) {
    if (auto channels = channels_of(file, layer + "."); !channels.empty()) return channels;
  }
  return image_channels(file, "");
}

void take_windows(const ExrFile& file, ReferenceImage& reference) {
  reference.width = file.width();
  reference.height = file.height();
  reference.x = file.x();
  reference.y = file.y();
  reference.display_width = file.display_width();
  reference.display_height = file.display_height();
}

void check_values(const ReferenceImage& reference, const std::vector<double>& values, const char* what, bool variance) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i]) && !(variance && values[i] < 0)) continue;
    const auto width = static_cast<std::size_t>(reference.width);
    const std::size_t channels = reference.channels.size(), pixel = i / channels;
    fail(ExitCode::kBadInput,
         "{}: {} is {} at pixel ({}, {}), channel {}, so nothing can be measured against it; mend or leave out the "
         "layer",
         reference.path, what, values[i], pixel % width, pixel / width, reference.channels[i % channels]);
  }
}

void check_shape(const ExrFile& file, const ReferenceImage& reference, const std::vector<std::string>& channels) {
  const std::string path = file.path().string();
  if (file.width() != reference.width || file.height() != reference.height) {
    fail(ExitCode::kBadInput, "{}: has {} x {} pixels, and the reference {} x {}", path, file.width(), file.height(),
         reference.width, reference.height);
  }
  if (file.x() != reference.x || file.y() != reference.y) {
    fail(ExitCode::kBadInput,
         "{}: its data window begins at ({}, {}) of the display window, and the reference's at ({}, {})", path,
         file.x(), file.y(), reference.x, reference.y);
  }
  if (channels.size() != reference.channels.size()) {
    fail(ExitCode::kBadInput, "{}: its channels are {}, and the reference's {}", path, joined(channels),
         joined(reference.channels));
  }
}

std::vector<double> read_half(const std::string& path, const ReferenceImage& reference, const std::string& layer) {
  const ExrFile file(path);
  const std::vector<std::string> channels = reference_channels(file, layer);
  check_shape(file, reference, channels);
  return read_values(file, channels);
}

void take_image(const std::string& path, const std::string& layer, ReferenceImage& reference) {
  const ExrFile file(path);
  reference.path = path;
  reference.channels = reference_channels(file, layer);
  take_windows(file, reference);
  reference.values.value = read_values(file, reference.channels);
  reference.values.variance = read_layer(file, "variance", reference.channels);
  if (!reference.values.variance.empty()) reference.variance_origin = "its layer variance";
  reference.values.half_a = read_layer(file, "half_a", reference.channels);
  reference.values.half_b = read_layer(file, "half_b", reference.channels);
  if (reference.values.half_a.empty() || reference.values.half_b.empty()) {
    reference.values.half_a.clear();
    reference.values.half_b.clear();
  } else {
    reference.halves_origin = "its layers half_a and half_b";
  }
}

void take_halves(const ReferenceFiles& files, ReferenceImage& reference) {
  if (files.image.empty()) take_image(files.half_a, files.layer, reference);
  reference.values.half_a = read_half(files.half_a, reference, files.layer);
  reference.values.half_b = read_half(files.half_b, reference, files.layer);
  reference.halves_origin = files.half_a + " and " + files.half_b;
}

void average_halves(ReferenceImage& reference) {
  const std::vector<double>&a = reference.values.half_a, &b = reference.values.half_b;
  reference.values.value.clear();
  reference.values.variance.clear();
  for (std::size_t p = 0; p < a.size(); ++p) {
    reference.values.value.push_back(0.5 * (a[p] + b[p]));
    reference.values.variance.push_back(0.25 * (a[p] - b[p]) * (a[p] - b[p]));
  }
  reference.path = reference.halves_origin;
  reference.variance_origin = "the difference of its halves";
}

}  // namespace

std::vector<std::string> image_channels(const ExrFile& file, const std::string& layer) {
  const std::vector<std::string> layers = layers_of(file);
  const std::string path = file.path().string();
  if (!layer.empty()) {
    const auto channels = channels_of(file, layer + ".");
    if (!channels.empty()) return channels;
    fail(ExitCode::kBadInput, "{}: has no layer '{}' with channels R, G, B or Y{} its layers: {}", path, layer,
         nearest_name(layer, layers).empty() ? ";" : did_you_mean(layer, layers),
         layers.empty() ? "none" : joined(layers));
  }
  if (auto channels = channels_of(file, ""); !channels.empty()) return channels;
  if (layers.size() == 1) return channels_of(file, layers.front() + ".");
  if (!layers.empty()) {
    fail(ExitCode::kBadInput, "{}: has no channels R, G, B or Y of its own; choose a layer with --layer: {}", path,
         joined(layers));
  }
  std::vector<std::string> names;
  for (const ExrFile::Channel& channel : file.channels()) names.push_back(channel.name);
  fail(ExitCode::kBadInput, "{}: has no channels R, G, B or Y; it has {}", path, joined(names));
}

std::string ReferenceImage::description() const {
  std::string text = fmt::format("{}: {} x {} pixels, channel{} {}", path, width, height,
                                 channels.size() == 1 ? "" : "s", joined(channels));
  if (x != 0 || y != 0 || width != display_width || height != display_height) {
    text += fmt::format(", the data window at ({}, {}) of a display window of {} x {}", x, y, display_width,
                        display_height);
  }
  text += variance_origin.empty() ? "; its own variance is not known and taken as 0, so errors include the reference's"
                                  : fmt::format("; its own variance, {:.3g} in the mean, is from {} and subtracted",
                                                values.mean_variance(), variance_origin);
  return text;
}

ReferenceImage read_reference(const ReferenceFiles& files) {
  ReferenceImage reference;
  if (!files.image.empty()) take_image(files.image, files.layer, reference);
  if (!files.half_a.empty()) take_halves(files, reference);
  check_values(reference, reference.values.half_a, "half A", false);
  check_values(reference, reference.values.half_b, "half B", false);
  if (files.image.empty()) average_halves(reference);
  check_values(reference, reference.values.value, "its value", false);
  check_values(reference, reference.values.variance, "its variance", true);
  reference.values.channels = reference.channels.size();
  CompensatedSum sum, squares;
  for (const double value : reference.values.value) {
    sum.add(value);
    squares.add(value * value);
  }
  reference.mean = sum.value() / static_cast<double>(reference.values.value.size());
  reference.mean_square = squares.value() / static_cast<double>(reference.values.value.size());
  return reference;
}

std::vector<double> read_like(const ExrFile& file, const ReferenceImage& reference, const std::string& layer) {
  const std::vector<std::string> channels = image_channels(file, layer);
  check_shape(file, reference, channels);
  return read_values(file, channels);
}

}  // namespace halfslope
