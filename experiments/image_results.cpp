#include "experiments/image_results.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "core/error.h"
#include "core/random.h"
#include "experiments/comparison_results.h"
#include "experiments/image_cells.h"
#include "experiments/interrupt.h"
#include "experiments/parallel.h"
#include "experiments/progress.h"

namespace halfslope {
namespace {

constexpr std::size_t kMemory = std::size_t{1} << 30;  // that cells at work together may take; one always may
constexpr std::size_t kBytesAnIntegral = 80;           // moments, the image as read and as numbers, decoding

/// The problem that an error is, under the path that its message begins with.
ImageProblem problem_of(const std::string& path, const Error& error) {
  std::string text = error.what();
  if (text.starts_with(path + ": ")) text.erase(0, path.size() + 2);
  return {path, text};
}

/// A cell at work, and what comes of it.
struct Measured {
  CellResult result;
  ImageCell cell;
  std::vector<ImageProblem> problems;
  std::size_t images = 0;
  bool finite = true;
};

/// Names what is not finite, and marks the cell with the first of it.
void note_nonfinite(const ExrFile& file, const std::vector<double>& values, const ReferenceImage& reference,
                    const std::string& layer, std::uint64_t seed, Measured& measured) {
  const auto width = static_cast<std::size_t>(reference.width);
  const std::size_t channels = reference.channels.size();
  std::size_t count = 0, infinite = 0, first = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    infinite += std::isinf(values[i]) ? 1 : 0;
    if (count++ == 0) first = i;
  }
  if (count == 0) return;
  const std::string channel = image_channels(file, layer)[first % channels];
  const bool overflow = infinite > 0 && file.find(channel)->half;
  measured.problems.push_back(
      {file.path().string(),
       fmt::format("{} of {} values are not finite ({} NaN, {} infinite{}), the first at pixel ({}, {}), channel {}",
                   count, values.size(), count - infinite, infinite,
                   overflow ? ": its numbers are halves, which end at 65504" : "", first / channels % width,
                   first / channels / width, channel)});
  if (!measured.finite) return;  // seeds are read in order, so the first stands
  measured.finite = false;
  measured.result.first_bad_replicate = seed;
  measured.result.first_bad_pixel = first / channels;
}

std::vector<NamedMetric> named_metrics(const ImageErrors& errors, const CellData& data,
                                       const CellStatistics& statistics) {
  std::vector<NamedMetric> rows;
  const std::vector<MetricValue> values = errors.metrics(data, statistics);
  for (std::size_t m = 0; m < values.size(); ++m) {
    const ImageMetric& metric = image_metrics()[m];
    rows.push_back({std::string(metric.name), metric.version, values[m]});
  }
  if (const auto halves = errors.half_buffers(data.bootstrap_seed)) rows.push_back({"half-buffer-mse", 1, *halves});
  return rows;
}

Measured measure_cell(const CellFiles& files, const ReferenceImage& reference, const std::string& layer, double unit,
                      const std::function<void()>& read_one) {
  Measured measured;
  measured.result.name = files.name;
  ImageErrors errors(reference.values);
  for (const CellFiles::Image& image : files.images) {
    if (interrupted()) return measured;
    try {
      const ExrFile file(image.path);
      const std::vector<double> values = read_like(file, reference, layer);
      note_nonfinite(file, values, reference, layer, image.seed, measured);
      errors.add(values);
      measured.cell.seeds.push_back(image.seed);
    } catch (const Error& error) {
      measured.problems.push_back(problem_of(image.path.string(), error));
    }
    read_one();
  }
  measured.images = measured.cell.seeds.size();
  if (measured.images == 0) return measured;
  CellData data = errors.data(hash_text(to_string(files.name)));
  data.rounding_mse = unit * unit * reference.mean_square;
  CellResult& result = measured.result;
  result.replicates = data.replicates;
  result.pixels = static_cast<std::int64_t>(reference.values.value.size() / reference.channels.size());
  result.facts.deterministic = data.replicates == 1;
  result.facts.reference_known = !reference.variance_origin.empty();
  result.facts.rounding_mse = data.rounding_mse;
  result.statistics = summarise(data);
  result.mse = data.mse.mean;
  result.reference_mse_variance = data.reference_mse_noise;
  measured.cell.replicates = data.per_replicate;
  measured.cell.metrics = named_metrics(errors, data, result.statistics);
  return measured;
}

/// Whether the first image of those that can be read stores halves.
bool stores_halves(const std::vector<const CellFiles*>& line, const std::string& layer) {
  for (const CellFiles* cell : line) {
    for (const CellFiles::Image& image : cell->images) {
      try {
        const ExrFile file(image.path);
        return file.find(image_channels(file, layer).front())->half;
      } catch (const Error&) {
        // It is named when it is measured.
      }
    }
  }
  return false;
}

/// The rounding unit of each cell's values; names its precision where the pattern does not.
std::vector<double> name_precisions(std::vector<CellFiles>& cells, const std::string& layer) {
  std::vector<double> units;
  for (std::size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
    std::vector<const CellFiles*> line;
    for (; end < cells.size() && same_line(cells[begin].name, cells[end].name); ++end) line.push_back(&cells[end]);
    const bool halves = stores_halves(line, layer);
    units.insert(units.end(), line.size(), halves ? 0x1p-11 : 0x1p-24);
    if (!cells[begin].name.precision.empty()) continue;
    for (std::size_t c = begin; c < end; ++c) cells[c].name.precision = halves ? "f16" : "f32";
  }
  return units;
}

/// Whether both are one file; a path that leads nowhere is none.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  return !a.empty() && !b.empty() && std::filesystem::equivalent(a, b, ignored);
}

ReferenceFiles of_scene(const ReferenceFiles& files, const std::string& scene) {
  return {with_scene(files.image, scene, "--reference"), with_scene(files.half_a, scene, "--reference-halves"),
          with_scene(files.half_b, scene, "--reference-halves"), files.layer};
}

/// The measured cells of one scene, in order; empty if its reference cannot be read, which is then a problem.
std::vector<Measured> measure_scene(const std::vector<CellFiles>& cells, std::span<const double> units,
                                    const ImageRequest& request, Progress& progress, ImageResults& images) {
  const std::string& scene = cells.front().name.scene;
  const ReferenceFiles files = of_scene(request.reference, scene);
  std::vector<Measured> measured;
  std::optional<ReferenceImage> reference;
  try {
    if (same_file(files.half_a, files.half_b)) {
      fail(ExitCode::kBadInput, "{}: is both of --reference-halves; two independent images are needed", files.half_a);
    }
    reference = read_reference(files);
  } catch (const Error& error) {
    images.problems.push_back(problem_of(files.image, error));
    return measured;
  }
  images.references.push_back({scene, reference->description(), !reference->variance_origin.empty(), reference->mean,
                               reference->values.mean_variance()});
  measured.resize(cells.size());
  const std::size_t most = std::max<std::size_t>(1, kMemory / (reference->values.value.size() * kBytesAnIntegral));
  with_threads(request.threads, [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    std::min(static_cast<std::size_t>(threads), most));
    tbb::parallel_for(
        std::size_t{0}, cells.size(),
        [&](std::size_t c) {
          measured[c] = measure_cell(cells[c], *reference, request.layer, units[c], [&] { progress.advance(1); });
        },
        tbb::simple_partitioner());
  });
  if (interrupted()) fail(ExitCode::kInterrupted, "interrupted; nothing was written");
  return measured;
}

void keep(std::vector<Measured> measured, ImageResults& images) {
  for (Measured& m : measured) {
    images.problems.insert(images.problems.end(), m.problems.begin(), m.problems.end());
    images.images += m.images;
    if (m.images == 0) continue;
    images.results.cells.push_back(std::move(m.result));
    images.cells.push_back(std::move(m.cell));
  }
}

/// Leaves out images that are their scene's reference: measured against itself it would have no error.
void leave_out_references(std::vector<ImageFile>& files, const ReferenceFiles& references,
                          std::vector<ImageProblem>& notes) {
  std::erase_if(files, [&](const ImageFile& file) {
    const ReferenceFiles own = of_scene(references, file.name.scene);
    const bool found =
        same_file(file.path, own.image) || same_file(file.path, own.half_a) || same_file(file.path, own.half_b);
    if (found) notes.push_back({file.path.string(), "is the reference, so not measured"});
    return found;
  });
}

}  // namespace

ImageResults analyze_images(const ImageRequest& request) {
  const ImagePattern pattern(request.pattern, "--pattern");
  const ReferenceFiles nameless = of_scene(request.reference, "");
  if (nameless.image != request.reference.image && !pattern.has("scene"))
    fail(ExitCode::kUsage, "--reference: has the field {{scene}}, which --pattern '{}' has not", request.pattern);
  ImageMatches matches = pattern.find();
  ImageResults images;
  images.problems = std::move(matches.problems);
  leave_out_references(matches.files, request.reference, images.notes);
  std::vector<CellFiles> cells = group_by_cell(matches.files, images.problems);
  const std::vector<ImageProblem> missing = missing_seeds(cells, pattern);
  images.problems.insert(images.problems.end(), missing.begin(), missing.end());
  const std::vector<double> units = name_precisions(cells, request.layer);
  Progress progress("images", static_cast<double>(matches.files.size()), request.quiet);
  for (std::size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
    while (end < cells.size() && cells[end].name.scene == cells[begin].name.scene) ++end;
    const auto at = [&](std::size_t c) { return cells.begin() + static_cast<std::ptrdiff_t>(c); };
    keep(measure_scene({at(begin), at(end)}, std::span(units).subspan(begin, end - begin), request, progress, images),
         images);
  }
  if (images.results.cells.empty()) {
    std::string named;
    for (const auto* list : {&images.notes, &images.problems}) {
      for (const ImageProblem& problem : *list) named += fmt::format("\n  {}: {}", problem.what, problem.text);
    }
    fail(ExitCode::kBadInput, "no image could be measured:{}", named);
  }
  pair_replicates(images.results, images.cells);
  RateResults fitted = fit_rates(images.results.cells, request.threads);
  images.results.rates = std::move(fitted.rates);
  images.results.local_rates = std::move(fitted.local);
  images.results.comparisons = compare_cells(images.results.cells, request.threads);
  return images;
}

}  // namespace halfslope
