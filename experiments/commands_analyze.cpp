// analyze: the same analysis for what was made elsewhere.
#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "experiments/commands.h"
#include "experiments/image_results.h"
#include "experiments/interrupt.h"
#include "experiments/manifest.h"
#include "experiments/message.h"
#include "experiments/run_folder.h"
#include "experiments/tables.h"

namespace halfslope {
namespace {

void write_tables(const RunFolder& folder, const ImageRequest& request, const ImageResults& images) {
  ReplicatesTable replicates;
  for (std::size_t c = 0; c < images.cells.size(); ++c)
    replicates.add(images.results.cells[c].name, images.cells[c].replicates, images.cells[c].seeds);
  const std::string name = std::filesystem::absolute(folder.path()).lexically_normal().filename().string();
  write_file_atomically(folder.path("replicates.csv"), replicates.take_text());
  write_file_atomically(folder.path("tails.csv"), tails_csv(images.results));
  write_file_atomically(folder.path("rates.csv"), rates_csv(images.results));
  write_file_atomically(folder.path("local_rates.csv"), local_rates_csv(images.results));
  if (const std::string comparisons = comparisons_csv(images.results); !comparisons.empty())
    write_file_atomically(folder.path("comparisons.csv"), comparisons);
  write_file_atomically(folder.path("metrics.csv"), metrics_csv(images));
  write_file_atomically(folder.path("convergence.csv"), convergence_csv(images.results));
  write_file_atomically(folder.path("manifest.json"), images_manifest(request, images, name));
}

}  // namespace

int analyze_images_command(const AnalyzeImagesArguments& a) {
  const InterruptGuard guard;
  if (a.reference.empty() && a.halves.empty())
    fail(ExitCode::kUsage, "--reference is missing: the image to measure against; or --reference-halves A.exr B.exr");
  ImageRequest request;
  request.pattern = a.pattern;
  request.reference = {a.reference, a.halves.empty() ? "" : a.halves.at(0), a.halves.empty() ? "" : a.halves.at(1),
                       a.layer};
  request.layer = a.layer;
  request.threads = a.threads;
  request.quiet = a.quiet;
  const std::string out = a.out.empty() ? "out/images" : a.out;
  if (std::filesystem::exists(std::filesystem::path(out) / "journal"))
    fail(ExitCode::kBadInput, "{}: holds the results of a run; choose another folder with --out", out);
  const ImageResults images = analyze_images(request);
  write_tables(RunFolder(out), request, images);
  if (a.json) {
    fmt::print("{}", cells_json(images.results));
    for (const SceneReference& reference : images.references) {
      if (!a.quiet) message("reference {}\n", reference.description);
    }
  } else if (!a.quiet) {
    for (const SceneReference& reference : images.references) fmt::print("reference {}\n", reference.description);
    fmt::print("\n{}\nTables: {}\n", summary(images.results), out);
  }
  if (!a.quiet) {
    for (const ImageProblem& note : images.notes) message("halfslope: {}: {}\n", note.what, note.text);
  }
  for (const ImageProblem& problem : images.problems) message("halfslope: {}: {}\n", problem.what, problem.text);
  if (images.problems.empty() || a.keep_going) return static_cast<int>(ExitCode::kDone);
  message("halfslope: {} image{} could be read and {} analysed; --keep-going makes that no failure\n", images.images,
          images.images == 1 ? "" : "s", images.images == 1 ? "is" : "are");
  return static_cast<int>(ExitCode::kBadInput);
}

}  // namespace halfslope
